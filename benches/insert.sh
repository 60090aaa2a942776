#!/bin/sh
# insert.sh TABLE DOCUMENT: replace what is between the markers of the document.
set -eu
begin='^<!-- bench: begin -->$' end='^<!-- bench: end -->$'
if ! { grep -q "$begin" "$2" && grep -q "$end" "$2"; }; then
    echo "$0: $2 has no markers" >&2
    exit 1
fi
sed -i -e "/$begin/,/$end/{//!d}" -e "/$begin/r $1" "$2"
