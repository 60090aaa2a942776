#!/bin/sh
# snippets.sh FILE.md DIRECTORY: write the whole programs among the fenced blocks of a document, one file each: C blocks with a main
# function, Fortran blocks with a program. The next text block after a program is its output: a file of the same name with .txt.
set -eu

mkdir -p "$2"
awk -v directory="$2" '
    function keep(extension) {
        file = sprintf("%s/snippet_%02d.%s", directory, count, extension)
        printf "%s", text > file
        close(file)
    }
    /^```(c|fortran|text)$/ { language = substr($0, 4); text = ""; next }
    /^```/ {
        if ((language == "c" && text ~ /int main *\(/) || (language == "fortran" && tolower(text) ~ /(^|\n) *program /)) {
            ++count
            keep(language == "c" ? "c" : "f90")
            has_output = 0
        } else if (language == "text" && count && !has_output) {
            keep("txt")
            has_output = 1
        }
        language = ""
        next
    }
    language != "" { text = text $0 "\n" }
' "$1"
