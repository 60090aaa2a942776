#!/bin/sh
# parallel.sh: results are bitwise equal for any number of threads and ranks. A line for each check, the counts in the last.
set -eu
# As root, with more ranks than cores, and in containers.
: "${MPIRUN:=mpirun --allow-run-as-root --oversubscribe --bind-to none --mca btl_vader_single_copy_mechanism none}"
export OPENBLAS_NUM_THREADS=1
. "$(dirname "$0")/../tools/checks.sh"

sweep() { # RANKS: the table is that of one rank
    # shellcheck disable=SC2086  # the launcher is a list of words
    $MPIRUN -n "$1" build/response_sweep "$work/$1.csv" cases/cylinder.nml cases/flat.nml && cmp "$work/1.csv" "$work/$1.csv"
}

peaks() { # the contacts that were sent give the peaks of the program without ranks
    build/forced_response cases/cylinder.nml "$work" &&
        awk -F, 'NR == FNR { peak[FNR] = $5; next } FNR > 1 && $1 == "cylinder" && $4 != peak[FNR] { print; wrong = 1 }
                 END { exit wrong || FNR != 27 }' "$work/cylinder_peaks.csv" "$work/1.csv"
}

fails() { # MESSAGE COMMAND...: the command ends with status 1 and the message
    message=$1
    status=0
    shift
    "$@" > "$work/output" 2>&1 || status=$?
    cat "$work/output"
    [ "$status" -eq 1 ] && grep -q "$message" "$work/output"
}

# Open MPI's launcher, told to abort, may fail itself while it ends.
all_end() { # MESSAGE COMMAND...: the command fails within a minute, with the message
    message=$1
    shift
    for _ in 1 2 3; do
        status=0
        # shellcheck disable=SC2086
        timeout --kill-after=5 60 $MPIRUN "$@" > "$work/output" 2>&1 || status=$?
        # Sometimes Open MPI's launcher hangs after MPI_Abort although all ranks have ended, and ignores SIGTERM.
        case $status in 124 | 137) ;; *) break ;; esac
    done
    cat "$work/output"
    [ "$status" -ne 0 ] && [ "$status" -ne 124 ] && [ "$status" -ne 137 ] && grep -q "$message" "$work/output"
}

check 'threads: 1, 2 and 4 give bitwise equal results' build/contact_threads 2000 4
check 'threads: fewer than requested is an error' fails '2 threads are not available' \
    env OMP_THREAD_LIMIT=1 build/contact_threads 100 2
for ranks in 1 2 4; do
    check "ranks: $ranks" sweep "$ranks"
done
check 'ranks: the peaks are those of forced_response' peaks
check 'ranks: an error of one ends all' all_end 'cannot be written' \
    --mca orte_abort_on_non_zero_status 0 -n 2 build/response_sweep "$work/none/table" cases/cylinder.nml

counts
