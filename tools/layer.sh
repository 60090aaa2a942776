#!/bin/sh
# layer.sh: computes loops, complex stiffness and loss per cycle of the contact of the README with layers, and draws
# docs/figures/layer.svg.
set -eu
cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"

"$CARGO" build --quiet --locked --package microslip-cli
program=$PWD/target/debug/microslip
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
picture=$PWD/docs/figures/layer.svg
cd "$work"

"$program" example > contact.toml
value() {
    awk -F, -v name="$1" '$1 == name { print $2 }'
}
stiffness=$("$program" contact contact.toml | value initial_stiffness)
normal_force=800
for share in 0 0.3 1 3; do
    for load in 0 0.05; do
        layer="--tangential-compliance $(awk "BEGIN { print $share / $stiffness }")"
        layer="$layer --stiffening-load $(awk "BEGIN { print $load * $normal_force }")"
        # Amplitude of the force: 0.9 mu N; of the displacement, in um, 0.01 to 10.
        # shellcheck disable=SC2086  # options
        amplitude=$("$program" curve contact.toml $layer --force 360 | awk -F, '/^[0-9]/ { print $1 }')
        # shellcheck disable=SC2086
        "$program" loop contact.toml $layer --amplitude "$amplitude" --points 201 |
            awk -F, '/^[0-9]/ { print 1e6 * $2, $3 }' > "loop_${share}_$load"
        # shellcheck disable=SC2086
        "$program" stiffness contact.toml $layer --from 1e-8 --to 1e-5 |
            awk -F, '/^[0-9]/ { print 1e6 * $1, 1e-6 * $2, 1e-6 * $3, 1e6 * $6 }' > "stiffness_${share}_$load"
    done
done
gnuplot << 'end' | sed '/^<desc>/d' > "$picture"
set terminal svg size 1100,400 font 'Helvetica,13' background 'white'
set multiplot layout 1,3
set grid lc rgb '#d8d8d8'
set key left top
set xlabel 'displacement [µm]'
set ylabel 'force [N]'
title(s) = s == 0 ? 'no layer' : sprintf('%g', s)
plot for [s in '0 0.3 1 3'] 'loop_'.s.'_0' with lines lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') title title(s + 0), \
     for [s in '0.3 1 3'] 'loop_'.s.'_0.05' with lines dt 2 lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') notitle
set logscale x
set key right top
set xlabel 'amplitude [µm]'
set ylabel 'K'' [N/µm]'
plot for [s in '0 0.3 1 3'] 'stiffness_'.s.'_0' using 1:2 with lines lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') notitle, \
     for [s in '0.3 1 3'] 'stiffness_'.s.'_0.05' using 1:2 with lines dt 2 lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') notitle
set logscale y
set yrange [0.01:]
set ylabel 'energy per cycle [µJ]'
plot for [s in '0 0.3 1 3'] 'stiffness_'.s.'_0' using 1:4 with lines lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') notitle, \
     for [s in '0.3 1 3'] 'stiffness_'.s.'_0.05' using 1:4 with lines dt 2 lc 1 + (s eq '0.3') + 2*(s eq '1') + 3*(s eq '3') notitle
end
