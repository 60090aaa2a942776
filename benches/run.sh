#!/bin/sh
# run.sh GNUPLOT [quick]: measure, draw, and write the table of the README; quick: fewer cases, no README.
set -eu
cd "$(dirname "$0")"
gnuplot=$1
results=results
flags=
if [ "${2:-}" = quick ]; then
    results=build/quick
    flags=--quick
fi
mkdir -p "$results"

# shellcheck disable=SC2086
build/bench $flags "$results"
for picture in force stiffness harmonic; do
    "$gnuplot" -e "results='$results'" "plots/$picture.gp"
done
if [ -z "$flags" ]; then
    ./insert.sh results/table.md ../README.md
fi

echo
echo "Written to benches/$results:"
ls -1 "$results"
