#!/bin/sh
# draw.sh [GNUPLOT]: draws every picture of docs/figures from its data. The version of gnuplot is not written into them.
set -eu
cd "$(dirname "$0")"
for plot in plots/*.gp; do
    case $plot in plots/style.gp | plots/complex_stiffness.gp) continue ;; esac
    picture=../../docs/figures/$(basename "$plot" .gp).svg
    "${1:-gnuplot}" -e "docs = '../../docs/figures'" "$plot" | sed '/^<desc>/d' > "$picture.new"
    mv "$picture.new" "$picture"
done
