#!/bin/sh
# self_test.sh: does compare.awk fail where it should, and only there?
set -eu

compare=$(dirname "$0")/compare.awk
. "$(dirname "$0")/../../tools/checks.sh"

cat > "$work/relations" << 'RELATIONS'
less: little < 0.5 * much + 10 because it is less
# -----
later: much < 0.5 * little because that will be less
RELATIONS
table() {
    printf '# rustc: %s\n# libc: glibc 2.36\nlittle %s\nmuch %s\n' "$1" "$2" "$3"
}
table 1.85.0 10000 100000 > "$work/recorded"

# ends STATUS PATTERN: the comparison of $work/counts ends so, and prints such a line.
ends() {
    status=0
    awk -f "$compare" "$work/relations" "$work/recorded" "$work/counts" > "$work/out" || status=$?
    cat "$work/out" && [ "$status" -eq "$1" ] && grep -q "$2" "$work/out"
}

table 1.85.0 10000 100000 > "$work/counts"
check 'the record itself passes' ends 0 '^much .* +0.0 %'
check 'what is wanted fails nothing' ends 0 '^wanted .* later:'
table 1.85.0 10000 106000 > "$work/counts"
check '6 % more fail' ends 1 '^much .* +6.0 %  ABOVE'
table 1.85.0 10000 104000 > "$work/counts"
check '4 % more pass' ends 0 '^much .* +4.0 %'
table 1.85.0 10000 94000 > "$work/counts"
check '6 % less pass, and are to be recorded' ends 0 '^much .* -6.0 %  below'
table 1.95.0 10000 106000 > "$work/counts"
check '6 % more by another compiler are told, and pass' ends 0 '^much .* ABOVE'
check 'the other compiler is named' ends 0 'rustc: 1.95.0, recorded with 1.85.0'
table 1.95.0 60000 100000 > "$work/counts"
check 'a relation that does not hold fails with any compiler' ends 1 '^NOT SO .* less:'
table 1.85.0 10000 100000 | sed /^much/d > "$work/counts"
check 'a case that is not counted fails' ends 1 '^much .* MISSING'
check 'and so does its relation' ends 1 '^NOT SO .* less:'
{ table 1.85.0 10000 100000; echo 'other 1'; } > "$work/counts"
check 'a new case is to be recorded' ends 0 '^other .* new'
table 1.95.0 10000 4000 > "$work/counts"
check 'what is wanted and holds is to be moved up' ends 1 '^MOVE UP .* later:'

counts
