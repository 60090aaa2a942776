# shellcheck shell=sh
# checks.sh, to be sourced: `check NAME COMMAND...` runs a check, `counts` prints the last line and returns the status of the
# script. $work is a temporary directory. Commands of several steps are functions that join them by &&: `set -e` is ignored there.

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

# The output of a command is shown if it fails.
check() {
    name=$1
    shift
    if "$@" > "$work/log" 2>&1; then
        passed=$((passed + 1))
        echo "passed: $name"
    else
        failed=$((failed + 1))
        echo "FAILED: $name"
        tail -n 40 "$work/log" | sed 's/^/    /'
    fi
}

counts() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
