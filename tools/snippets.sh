#!/bin/sh
# snippets.sh FILE.md DIRECTORY: write the whole programs among the fenced blocks of a document, one file each:
# C blocks with a main function, Fortran blocks with a program.
set -eu

mkdir -p "$2"
awk -v directory="$2" '
    /^```c$/       { extension = "c"; text = ""; next }
    /^```fortran$/ { extension = "f90"; text = ""; next }
    /^```/ {
        if ((extension == "c" && text ~ /int main *\(/) ||
            (extension == "f90" && tolower(text) ~ /(^|\n) *program /)) {
            file = sprintf("%s/snippet_%02d.%s", directory, ++count, extension)
            printf "%s", text > file
            close(file)
        }
        extension = ""
        next
    }
    extension != "" { text = text $0 "\n" }
' "$1"
