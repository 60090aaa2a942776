#!/bin/sh
# self_test.sh: does compare.awk fail where it should, and only there?
set -eu

compare=$(dirname "$0")/compare.awk
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

cat > "$work/relations" << 'RELATIONS'
less: little < 0.5 * much + 10 because it is less
# -----
later: much < 0.5 * little because that will be less
RELATIONS
table() {
    printf '# rustc: %s\n# libc: glibc 2.36\nlittle %s\nmuch %s\n' "$1" "$2" "$3"
}
table 1.85.0 10000 100000 > "$work/recorded"

# check SENTENCE STATUS PATTERN: the comparison of $work/counts ends so, and prints such a line.
check() {
    status=0
    awk -f "$compare" "$work/relations" "$work/recorded" "$work/counts" > "$work/out" || status=$?
    if [ "$status" -eq "$2" ] && grep -q "$3" "$work/out"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "not so: $1"
        cat "$work/out"
    fi
}

table 1.85.0 10000 100000 > "$work/counts"
check 'the record itself passes' 0 '^much .* +0.0 %'
check 'what is wanted fails nothing' 0 '^wanted .* later:'
table 1.85.0 10000 106000 > "$work/counts"
check '6 % more fail' 1 '^much .* +6.0 %  ABOVE'
table 1.85.0 10000 104000 > "$work/counts"
check '4 % more pass' 0 '^much .* +4.0 %'
table 1.85.0 10000 94000 > "$work/counts"
check '6 % less pass, and are to be recorded' 0 '^much .* -6.0 %  below'
table 1.95.0 10000 106000 > "$work/counts"
check '6 % more by another compiler are told, and pass' 0 '^much .* ABOVE'
check 'the other compiler is named' 0 'rustc: 1.95.0, recorded with 1.85.0'
table 1.95.0 60000 100000 > "$work/counts"
check 'a relation that does not hold fails with any compiler' 1 '^NOT SO .* less:'
table 1.85.0 10000 100000 | sed /^much/d > "$work/counts"
check 'a case that is not counted fails' 1 '^much .* MISSING'
check 'and so does its relation' 1 '^NOT SO .* less:'
{ table 1.85.0 10000 100000; echo 'other 1'; } > "$work/counts"
check 'a new case is to be recorded' 0 '^other .* new'
table 1.95.0 10000 4000 > "$work/counts"
check 'what is wanted and holds is to be moved up' 1 '^MOVE UP .* later:'

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
