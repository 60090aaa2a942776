#!/bin/sh
# interface.sh [--record]: is the interface of the header the one that was recorded for its MSLIP_ABI_VERSION, in
# packaging/abi/? A record has one line for each constant, type and function. What a record has must stay as it is, or
# else the version of the interface is raised; what is new is added by --record. MSLIP_HEADER and MSLIP_RECORDS name
# another header and other records.
set -eu

cd "$(dirname "$0")/.."
: "${MSLIP_HEADER:=include/microslip.h}" "${MSLIP_RECORDS:=packaging/abi}"
case ${1-} in
    '' | --record) mode=${1-} ;;
    *) echo "usage: $0 [--record]" >&2; exit 2 ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

number() {
    sed -n "s/^#define MSLIP_$1 //p" "$MSLIP_HEADER"
}
abi=$(number ABI_VERSION)
record=$MSLIP_RECORDS/$abi.txt
# Versions of one series are compatible: the first number, before 1.0 the first two.
series=$(number VERSION_MAJOR)
[ "$series" -gt 0 ] || series=0.$(number VERSION_MINOR)

# One line for each constant, type and function: comments go, and a declaration ends with the first semicolon outside of
# braces.
sed 's,//.*,,' "$MSLIP_HEADER" | awk '
    /^#define MSLIP_(VERSION|ABI_VERSION)/ { next }
    /^#define MSLIP_[A-Z0-9_]+ / { $1 = $1; print; next }
    /^#/ || /^extern "C"/ || /^\/\*/ || /^} *$/ { next }
    {
        text = text " " $0
        depth += gsub(/{/, "{") - gsub(/}/, "}")
        if (depth == 0 && /;[ ]*$/) {
            gsub(/[ \t]+/, " ", text)
            sub(/^ /, "", text)
            print text
            text = ""
        }
    }
    END { if (text ~ /[^ ]/) { print "not understood:" text; exit 1 } }' > "$work/present"

fail() {
    echo "$*"
    exit 1
}

[ -e "$record" ] || echo "# Interface $abi, of microslip $series" > "$work/first"
{ [ ! -e "$record" ] || grep -v '^# ' "$record"; } | sort > "$work/before"
sort "$work/present" > "$work/after"
comm -23 "$work/before" "$work/after" > "$work/gone"
comm -13 "$work/before" "$work/after" > "$work/new"

if [ -s "$work/gone" ]; then
    cat "$work/gone"
    fail "These changed or went since interface $abi was recorded: raise MSLIP_ABI_VERSION (and the version, see CONTRIBUTING.md)."
fi

# A status code that was given once keeps its name, in every version.
cat "$MSLIP_RECORDS"/*.txt "$work/present" 2> /dev/null | awk '
    $1 == "#define" && $2 == "MSLIP_OK" { status = 1 }
    $1 ~ /^typedef/ { status = 0 }
    status && $1 == "#define" {
        if ($3 in name && name[$3] != $2) { print $3 ": " name[$3] ", " $2; bad = 1 }
        name[$3] = $2
    }
    END { exit bad }' > "$work/reused" || { cat "$work/reused"; fail 'These status codes have two names.'; }

# Another interface is another series of versions.
for other in "$MSLIP_RECORDS"/*.txt; do
    if [ ! -e "$other" ] || [ "$other" = "$record" ]; then continue; fi
    [ "$(sed -n '1s/.* of microslip //p' "$other")" != "$series" ] ||
        fail "Interface $abi cannot be of microslip $series: $other is. Raise the version, see CONTRIBUTING.md."
done

if [ "$mode" = --record ]; then
    { if [ -e "$work/first" ]; then cat "$work/first"; else sed -n '/^# /p' "$record"; fi; cat "$work/present"; } > "$work/record"
    mkdir -p "$MSLIP_RECORDS"
    mv "$work/record" "$record"
    echo "$(wc -l < "$work/new") recorded in $record"
elif [ -s "$work/new" ]; then
    cat "$work/new"
    fail "These are not in $record: make interface-record, and commit it."
else
    echo "interface $abi is the recorded one: $(wc -l < "$work/present") constants, types and functions"
fi
