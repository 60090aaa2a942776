#!/bin/sh
# links.sh: every relative link in a document leads to a file of the repository, and every anchor to a heading.
# shellcheck disable=SC2013,SC2016  # words without blanks; backticks of Markdown
set -eu
cd "$(dirname "$0")/.."

headings() {
    sed -n '/^```/,/^```/d; s/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/[^[:alnum:] _-]//g; s/ /-/g'
}

passed=0
failed=0
for file in $(git ls-files '*.md'); do
    for link in $(sed '/^```/,/^```/d' "$file" | grep -o '\](\([^) ]*\))' | sed 's/^](//; s/)$//; /:/d'); do
        target=$file
        case $link in [!#]*) target=$(dirname "$file")/${link%%#*} ;; esac
        case $link in *#*) anchor=${link#*#} ;; *) anchor= ;; esac
        if [ -e "$target" ] && { [ -z "$anchor" ] || headings "$target" | grep -qx -- "$anchor"; }; then
            passed=$((passed + 1))
        else
            echo "$file: $link"
            failed=$((failed + 1))
        fi
    done
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
