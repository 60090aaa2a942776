#!/bin/sh
# run.sh [--record] PREFIX: count the instructions of the installed library, case by case, and compare them with those that
# were recorded and with each other; or record them.
#
# Instructions are the same in every run, where a clock is not. What the C library executes counts too: which of its
# functions are called, and how often, is the library's choice. So the record holds for one compiler, one C library and the
# processor that valgrind shows it; elsewhere it is only reported. The relations hold everywhere.
set -eu

record=
[ "${1-}" != --record ] || { record=yes; shift; }
[ $# -eq 1 ] || { echo "usage: $0 [--record] PREFIX" >&2; exit 2; }
prefix=$1
here=$(dirname "$0")
: "${CC:=cc}" "${VALGRIND:=valgrind}" "${READELF:=readelf}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

$CC -std=c99 -Wall -Wextra -Wpedantic -Werror -O2 -I"$prefix/include" "$here/cases.c" \
    "$prefix/lib/libmicroslip.a" -lm -o "$work/cases"

# The compiler that made the archive left its name in it.
compiler=$($READELF -p .comment "$prefix/lib/libmicroslip.a" | sed -n 's/.*rustc version \(.*\)/\1/p' | sort -u)
echo "# rustc: $compiler" > "$work/counts"
$VALGRIND -q --tool=callgrind --combine-dumps=yes --callgrind-out-file="$work/dump" "$work/cases" >> "$work/counts"
awk '/^desc: Trigger: Client Request: / { name = $NF }
     /^summary: / && name { print name, $2; name = "" }' "$work/dump" >> "$work/counts"

if [ "$record" ]; then
    { echo '# Instructions of each case, made by "make instructions-record" with'; cat "$work/counts"; } \
        > "$here/recorded.txt"
    echo "recorded in $here/recorded.txt"
else
    "$here/self_test.sh"
    awk -f "$here/compare.awk" "$here/relations.txt" "$here/recorded.txt" "$work/counts"
fi
