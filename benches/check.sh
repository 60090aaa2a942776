#!/bin/sh
# check.sh [PREFIX]: builds the benchmark against an installed microslip and tests it; the last line has the counts.
set -eu
cd "$(dirname "$0")"
make --silent --no-print-directory check PREFIX="${1:-../dist}"
