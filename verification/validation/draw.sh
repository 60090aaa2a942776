#!/bin/sh
# draw.sh [GNUPLOT]: draws the picture of docs/validation.md from its data. The version of gnuplot is not written into it.
set -eu
cd "$(dirname "$0")"
picture=../../docs/figures/contact_code.svg
"${1:-gnuplot}" -e "docs = '../../docs/figures'" plots/contact_code.gp | sed '/^<desc>/d' > "$picture.new"
mv "$picture.new" "$picture"
