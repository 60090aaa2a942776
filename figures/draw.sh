#!/bin/sh
# draw.sh [GNUPLOT]: draws every picture of docs/figures from its data.
set -eu
cd "$(dirname "$0")"
for plot in plots/*.gp; do
    [ "$plot" = plots/style.gp ] || "${1:-gnuplot}" -e "docs = '../docs/figures'" "$plot"
done
