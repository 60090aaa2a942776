#!/bin/sh
# draw.sh [GNUPLOT]: draws the pictures of docs/accuracy.md and docs/validation.md from their data. The version of gnuplot is not written into them.
set -eu
cd "$(dirname "$0")"
for name in accuracy contact_code fretting two_directions; do
    picture=../../docs/figures/$name.svg
    "${1:-gnuplot}" -e "docs = '../../docs/figures'" "plots/$name.gp" | sed '/^<desc>/d' > "$picture.new"
    mv "$picture.new" "$picture"
done
