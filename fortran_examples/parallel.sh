#!/bin/sh
# Contacts distributed over threads, and a sweep distributed over ranks of which one is killed: results are bitwise equal for
# any number of them. A line for each check, the counts in the last.
set -eu
# As root and with more ranks than cores, for this is a test; in containers, where a process may not read another's memory.
: "${MPIRUN:=mpirun --allow-run-as-root --oversubscribe --bind-to none --mca btl_vader_single_copy_mechanism none}"
export OPENBLAS_NUM_THREADS=1
. "$(dirname "$0")/../tools/checks.sh"

# sweep RANKS DIRECTORY [CASE...]: each rank leaves its process id beside the results.
sweep() {
    ranks=$1
    directory=$work/$2
    shift 2
    [ $# -gt 0 ] || set -- cases/cylinder.nml cases/flat.nml
    mkdir -p "$directory"
    # shellcheck disable=SC2086,SC2016  # the command is a list; the rank is known to what is started
    $MPIRUN -n "$ranks" sh -c 'echo $$ > "$1/rank.$OMPI_COMM_WORLD_RANK" && shift && exec "$@"' sh "$directory" \
        build/response_sweep "$directory" 5 60 "$@" > "$directory/progress" 2>&1
}

same() {
    for file in sweep.dat sweep.csv sweep_peaks.csv; do
        cmp "$work/one/$file" "$work/$1/$file" || return 1
    done
}

# printed DIRECTORY PATTERN
printed() {
    grep -q "$2" "$work/$1/progress" || { cat "$work/$1/progress"; return 1; }
}

# kill_rank RANK DIRECTORY: started with two ranks, killed after 20 of the units; some must remain.
kill_rank() {
    sweep 2 "$2" &
    run=$!
    until printed "$2" '^unit 20/' > "$work/output" 2>&1; do
        kill -0 "$run" || return 1
        sleep 0.05
    done
    kill -9 "$(cat "$work/$2/rank.$1")" || return 1
    ! wait "$run" && ! printed "$2" '^solved' > "$work/output"
}

resumes() {
    sweep "$1" "$2" && printed "$2" "^130 units, [2-9][0-9] of them found\|^130 units, 1[0-2][0-9] of them found" && same "$2"
}

# The grid of frequencies is coarse for a sharp resonance, not for a damped one: 1 Hz against several.
like_continuation() {
    mkdir "$work/continuation" && build/forced_response cases/cylinder.nml "$work/continuation" &&
        awk -F, 'FNR == 1 { next }
                 NR == FNR { peak[$2] = $4; next }
                 $1 == "cylinder" {
                     ++loads
                     part = $4 / peak[$2]
                     print "load factor", $2, "max. amplitude over the peak", part
                     if (part > 1 + 1e-8 || part < ($2 > 2 && $2 < 200 ? 0.99 : 0.1)) ++wrong
                 }
                 END { exit loads != 13 || wrong }' "$work/continuation/cylinder_peaks.csv" "$work/one/sweep_peaks.csv"
}

# repaired COMMAND...: the complete file is restored after the command has damaged one unit.
repaired() {
    rm -rf "$work/damaged" && cp -R "$work/one" "$work/damaged" && "$@" && ! cmp "$work/one/sweep.dat" "$work/damaged/sweep.dat" &&
        sweep 1 damaged && printed damaged '^130 units, 129 of them found' && same damaged
}

cut_short() {
    dd if="$work/one/sweep.dat" of="$work/damaged/sweep.dat" bs=1 count=$(($(wc -c < "$work/one/sweep.dat") - 7))
}

change_byte() {
    printf 'x' | dd of="$work/damaged/sweep.dat" bs=1 seek=100000 conv=notrunc
}

rejects_other_cases() {
    cp -R "$work/one" "$work/other" && ! sweep 2 other cases/flat.nml cases/cylinder.nml &&
        printed other 'sweep.dat has the results of other cases' && same other
}

fewer_threads() {
    ! OMP_THREAD_LIMIT=1 build/contact_threads 100 2 2> "$work/output" && grep '2 threads are not available' "$work/output"
}

# If the launcher does not end the ranks that wait for one that has ended: 1 is the status of the program, not of timeout.
ends_all() {
    status=0
    # shellcheck disable=SC2086
    timeout 60 $MPIRUN --mca orte_abort_on_non_zero_status 0 -n 3 build/response_sweep "$work/nowhere" 5 60 cases/flat.nml \
        2> "$work/output" || status=$?
    grep 'nowhere/sweep.dat: cannot be opened' "$work/output" && [ "$status" -eq 1 ]
}

disk_full() {
    cp -R "$work/one" "$work/full" && ln -sf /dev/full "$work/full/sweep.csv" && ! sweep 1 full &&
        printed full 'sweep.csv: could not be written'
}

check 'threads: 1, 2 and 4 give bitwise equal results' build/contact_threads 2000 4
check 'threads: fewer than requested is an error' fewer_threads
check 'ranks: 1' sweep 1 one
check 'control: a balance was found at every point' sh -c "awk -F, 'NR > 1 && \$5 != 1' '$work/one/sweep.csv' | cmp - /dev/null"
check 'the largest amplitudes are those of the continuation' like_continuation
for ranks in 2 4; do
    check "ranks: $ranks" sweep "$ranks" "by_$ranks"
    check "ranks: $ranks write the same bytes as 1" same "by_$ranks"
    check "ranks: the last of $ranks solved units" printed "by_$ranks" ", rank $((ranks - 1)),"
done
check 'killed: rank 1 of 2' kill_rank 1 killed
check 'killed: 4 ranks resume and write the same bytes as 1' resumes 4 killed
check 'killed: rank 0 of 2' kill_rank 0 killed_first
check 'killed: 1 rank resumes and writes the same bytes as 1' resumes 1 killed_first
check 'a record cut short is solved again' repaired cut_short
check 'a record with a changed byte is solved again' repaired change_byte
check 'results of other cases are rejected, and kept' rejects_other_cases
check 'a rank that fails ends all' ends_all
check 'a table on a full disk is an error' disk_full

counts
