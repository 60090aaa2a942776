#!/bin/sh
# coverage.sh [PERCENT]: how many lines of src/, its tests apart, the Rust tests and the C drivers run; fails below 98 %. The
# lines that nothing ran are listed. Needs the Rust component llvm-tools, and installs it by rustup.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
least=${1:-98}
build=$PWD/target/coverage

tools=$(rustc --print target-libdir)/../bin
if [ ! -x "$tools/llvm-cov" ] && ! rustup component add llvm-tools; then
    echo 'llvm-cov is not there and cannot be installed here (rustup component add llvm-tools)'
    exit 0
fi
rm -rf "$build/profiles"

# Counters in the packages of this repository alone: those of others would only cost time.
mkdir -p "$build"
printf '#!/bin/sh\nexec "$@" -Cinstrument-coverage\n' > "$build/rustc"
chmod +x "$build/rustc"
export RUSTC_WORKSPACE_WRAPPER="$build/rustc" CARGO_TARGET_DIR="$build"
export LLVM_PROFILE_FILE="$build/profiles/%m-%p.profraw"
"$CARGO" test --release --locked --package microslip --no-fail-fast > "$build/log" 2>&1 ||
    { cat "$build/log"; echo '0 passed, 1 failed'; exit 1; }
"$tools/llvm-profdata" merge --sparse "$build"/profiles/*.profraw -o "$build/merged.profdata"

# The test programs, and the C drivers that one of them has built; each by itself, for a function that was compiled twice is
# lost where both are looked at together.
for program in $(sed -n 's/^ *Running .*(\(.*\))$/\1/p' "$build/log") "$build"/tmp/c_drivers/*; do
    if [ -f "$program" ] && [ -x "$program" ]; then
        "$tools/llvm-cov" export --format=lcov --instr-profile "$build/merged.profdata" "$program" --sources src
    fi
done > "$build/lcov"

# Tests stand at the end of a file.
awk -v least="$least" -v root="$PWD/" '
    sub(/^SF:/, "") { name = $0; if (index(name, root) == 1) name = substr(name, length(root) + 1)
                      if (!(name in end)) end[name] = index(name, "src/") == 1 ? tests_of(name) : 0 }
    sub(/^DA:/, "") && split($0, at, ",") && at[1] + 0 < end[name] { count[name ":" at[1]] += at[2] }
    function tests_of(name,   line, number) {
        number = 1
        while ((getline line < name) > 0 && line != "#[cfg(test)]") ++number
        close(name)
        return number
    }
    END {
        for (line in count) {
            ++lines
            if (count[line] > 0) ++run
            else print line ": not run" | "sort -t: -k1,1 -k2,2n"
        }
        close("sort -t: -k1,1 -k2,2n")
        printf "%d of %d lines of src/ are run: %.2f %%, and %s %% are wanted\n", run, lines, 100 * run / lines, least
        good = lines > 1000 && 100 * run >= least * lines
        print good + 0 " passed, " 1 - good " failed"
        exit !good
    }' "$build/lcov"
