#!/bin/sh
# identification.sh: computes noisy loops of a rig, fits them, and draws docs/figures/identification.svg.
set -eu
cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"

"$CARGO" build --quiet --locked --package microslip-cli
program=$PWD/target/debug/microslip
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
picture=$PWD/docs/figures/identification.svg
cd "$work"

"$program" example > contact.toml
contact='contact.toml --edge-radius 50e-3 --length 2e-3 --normal-force 80'
# A rig of 5e-9 m/N in series; noise of 0.03 N and 0.3 nm (Lehmer's generator; Box and Muller); amplitudes of 0.7 and 2 slip
# displacements of the contact.
for amplitude in 0.7 2; do
    # shellcheck disable=SC2086  # options
    "$program" loop $contact --flat-half-width 1e-4 --relative --amplitude "$amplitude" --points 300 --out computed.csv
    awk -F, -v series=5e-9 -v state="${amplitude#*.}1" '
        function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
        function noise() { return sqrt(-2 * log(uniform())) * cos(6.283185307 * uniform()) }
        /^amplitude/ { print "displacement [um],force [N]" }
        /^[0-9]/ { printf "%.5f,%.4f\n", 1e6 * ($2 + series * $3) + 3e-4 * noise(), $3 + 0.03 * noise() }
    ' computed.csv > "loop$amplitude.csv"
done
# The start values of friction and flat are wrong by design.
# shellcheck disable=SC2086
"$program" fit $contact --friction-coefficient 0.3 --flat-half-width 5e-5 \
    --measured loop0.7.csv,loop2.csv --data-units um,N --plot "$picture"
