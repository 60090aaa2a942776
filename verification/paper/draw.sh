#!/bin/sh
# draw.sh [GNUPLOT]: draws every picture of docs/figures from its data, and notes what it was drawn from.
set -eu
cd "$(dirname "$0")"
for plot in plots/*.gp; do
    [ "$plot" = plots/style.gp ] || "${1:-gnuplot}" -e "docs = '../../docs/figures'" "$plot"
done
cd ../..
sha256sum docs/figures/data/*.csv verification/paper/plots/*.gp > docs/figures/drawn.sha256
