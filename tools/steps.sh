# shellcheck shell=sh
# steps.sh, to be sourced by test.sh and check.sh: `step` runs a command, `together` runs functions side by side, `summary` ends the script.

. tools/checks.sh
: "${CXX:=g++}"
export CC CXX FC
# The seed of all random tests.
: "${MICROSLIP_SEED:=1}"
export MICROSLIP_SEED
# One compilation of the library serves all tests and tools: of fewer packages, crates that they share have other features.
# shellcheck disable=SC2034  # for the scripts that source this one
workspace='--locked --workspace --exclude microslip-fuzz'
unset CARGO_TARGET_DIR # programs are in target/
: > "$work/counts"

# step NAME COMMAND...: counts the tests that the command reports (cargo's "test result:" or "N passed, N failed"), or itself as one; exit
# status 77, that what it needs cannot be installed, is a failure unless MICROSLIP_MAY_SKIP is set. Functions as commands join their commands by &&: a failure does not end the shell there.
step() {
    step=$1
    shift
    log=$(mktemp "$work/log.XXXXXX")
    status=0
    begun=$(date +%s)
    "$@" > "$log" 2>&1 || status=$?
    seconds=$(($(date +%s) - begun))
    if [ "$status" -eq 77 ] && [ -n "${MICROSLIP_MAY_SKIP:-}" ]; then
        printf '%-72s SKIPPED: %s\n' "$step" "$(tail -n 1 "$log")"
        return
    fi
    # Failing Rust tests print what the programs that they run have counted: only cargo's own counts are taken.
    awk -v status="$status" '
        /^test result: /                 { tests += $4; failures += $6; ++results }
        /^[0-9]+ passed, [0-9]+ failed$/ { passed += $1; failed += $3; ++counts }
        END {
            if (results) { passed = tests; failed = failures } else if (!counts) passed = !status
            if (!failed && (status || !passed)) failed = 1
            print passed + 0, failed + 0
        }' "$log" > "$log.counts"
    read -r good bad < "$log.counts"
    echo "$good $bad" >> "$work/counts"
    if [ "$bad" -eq 0 ]; then
        printf '%-72s %s passed, %s s\n' "$step" "$good" "$seconds"
    else
        {
            printf '%-72s FAILED (%s passed, %s failed)\n' "$step" "$good" "$bad"
            sed 's/^/    /' "$log"
            echo "    again: MICROSLIP_SEED=$MICROSLIP_SEED $*"
        } > "$log.report"
        cat "$log.report"
    fi
}

# together FUNCTION...: at the same time.
together() {
    for function in "$@"; do
        "$function" &
    done
    wait
}

summary() {
    awk '{ passed += $1; failed += $2 } END { printf "%d passed, %d failed\n", passed, failed; exit failed > 0 || passed == 0 }' "$work/counts"
}

# Installed elsewhere, then moved: no file may depend on its place.
install_and_move() {
    make install PREFIX=/opt/microslip DESTDIR="$work/stage" && mv "$work/stage/opt/microslip" "$prefix"
}

# A program of a document prints its result in the document.
# shellcheck disable=SC2046,SC2086  # flags are lists
snippet() {
    case $1 in
        *.c) compiler="$CC -std=c99 -Wall -Wextra -Wpedantic -Werror -O1" ;;
        *.f90) compiler="$FC -J $work $prefix/include/microslip.f90" ;;
    esac
    $compiler "$1" -o "$work/snippet" $(pkg-config --cflags --libs --static microslip) && "$work/snippet" > "$work/snippet.txt" &&
        diff "${1%.*}.txt" "$work/snippet.txt"
}

# programs_of_documents LANGUAGE...
programs_of_documents() {
    for document in README.md docs/*.md; do
        name=$(basename "$document" .md)
        tools/snippets.sh "$document" "$work/snippets/$name"
        for language in "$@"; do
            for file in "$work/snippets/$name"/*."$language"; do
                [ ! -e "$file" ] || step "$name: $(basename "$file")" snippet "$file"
            done
        done
    done
}

prefix=$work/moved
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
