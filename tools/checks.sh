# shellcheck shell=sh
# checks.sh, to be sourced: `check` tells whether something holds, `counts` says how often in the last line. $work is a
# directory for what comes up on the way.

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

# check SENTENCE COMMAND...: what the command prints is shown where it fails. Commands of several steps are functions, which
# join them by &&, for a failure does not end the shell there.
check() {
    sentence=$1
    shift
    if "$@" > "$work/log" 2>&1; then
        passed=$((passed + 1))
        echo "holds: $sentence"
    else
        failed=$((failed + 1))
        echo "NOT SO: $sentence"
        tail -n 40 "$work/log" | sed 's/^/    /'
    fi
}

# The last line, and the status of the script.
counts() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
