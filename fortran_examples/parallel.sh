#!/bin/sh
# parallel.sh: results are bitwise equal for any number of threads. A line for each check, the counts in the last.
set -eu
. "$(dirname "$0")/../tools/checks.sh"

fails() { # MESSAGE COMMAND...: the command ends with status 1 and the message
    message=$1
    status=0
    shift
    "$@" > "$work/output" 2>&1 || status=$?
    cat "$work/output"
    [ "$status" -eq 1 ] && grep -q "$message" "$work/output"
}

check 'threads: 1, 2 and 4 give bitwise equal results' build/contact_threads 2000 4
check 'threads: fewer than requested is an error' fails '2 threads are not available' \
    env OMP_THREAD_LIMIT=1 build/contact_threads 100 2

counts
