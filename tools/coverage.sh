#!/bin/sh
# coverage.sh [PERCENT]: line coverage of src/, without its test modules, by the unit tests and the tests named below, but for long random
# ones; fails below 98 %. Lists the lines that are not covered. Needs the Rust component llvm-tools, which it installs by rustup; exit
# status 77 if that is not possible.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
least=${1:-98}
build=$PWD/target/coverage
tools=$(rustc --print target-libdir)/../bin
if [ ! -x "$tools/llvm-cov" ] && ! rustup component add llvm-tools; then
    echo 'llvm-cov cannot be installed (rustup component add llvm-tools)'
    exit 77
fi

# Only the packages of the workspace are instrumented.
rm -rf "$build/profiles"
mkdir -p "$build"
printf '#!/bin/sh\nexec "$@" -Cinstrument-coverage\n' > "$build/rustc"
chmod +x "$build/rustc"
export RUSTC_WORKSPACE_WRAPPER="$build/rustc" CARGO_TARGET_DIR="$build" LLVM_PROFILE_FILE="$build/profiles/%m-%p.profraw"
# Threads that count the same lines wait for each other: two take twice the time.
export RUST_TEST_THREADS=1
"$CARGO" test --locked --package microslip --lib --test ffi --test histories --test two_directions -- \
    --skip arbitrary_bytes --skip sixteen_nodes --skip states_as_text \
    --skip jacobians_of --skip the_mean_force > "$build/log" 2>&1 ||
    { cat "$build/log"; echo '0 passed, 1 failed'; exit 1; }
"$tools/llvm-profdata" merge --sparse "$build"/profiles/*.profraw -o "$build/merged.profdata"

# Each program separately: llvm-cov omits functions of which there are different copies.
sed -n 's/^ *Running .*(\(.*\))$/\1/p' "$build/log" | while read -r program; do
    "$tools/llvm-cov" export --format=lcov --instr-profile "$build/merged.profdata" "$program" --sources src
done > "$build/lcov"

# A test module is the end of its file, or tests.rs.
grep -n '^#\[cfg(test)\]$' -r src --include='*.rs' | sed 's/:#.*//' > "$build/test_modules"
awk -v least="$least" -v root="$PWD/" '
    NR == FNR { split($0, at, ":"); end[at[1]] = at[2]; next }
    sub(/^SF:/, "") { name = index($0, root) == 1 ? substr($0, length(root) + 1) : $0 }
    sub(/^DA:/, "") && name ~ /^src\// && name !~ /\/tests\.rs$/ {
        split($0, at, ",")
        if (!(name in end) || at[1] + 0 < end[name]) count[name ":" at[1]] += at[2]
    }
    END {
        for (line in count) {
            ++lines
            if (count[line] > 0) ++covered
            else print line ": not covered" | "sort -t: -k1,1 -k2,2n"
        }
        close("sort -t: -k1,1 -k2,2n")
        printf "%d of %d lines are covered: %.2f %%, at least %s %% required\n", covered, lines, 100 * covered / lines, least
        good = lines > 1000 && 100 * covered >= least * lines
        print good + 0 " passed, " 1 - good " failed"
        exit !good
    }' "$build/test_modules" "$build/lcov"
