#!/bin/sh
# insert.sh TABLE DOCUMENT: puts the table between the document's two markers.
set -eu
table=$1
document=$2
for marker in '<!-- bench: begin -->' '<!-- bench: end -->'; do
    grep -qxF -e "$marker" "$document" || { echo "$0: $document has no line $marker" >&2; exit 1; }
done
new=$(mktemp)
trap 'rm -f "$new"' EXIT
awk -v table="$table" '
    /^<!-- bench: end -->$/   { inside = 0 }
    !inside                   { print }
    /^<!-- bench: begin -->$/ { inside = 1; while ((getline line < table) > 0) print line }
' "$document" > "$new"
# Written in place: owner and mode stay.
cat "$new" > "$document"
