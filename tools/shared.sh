#!/bin/sh
# shared.sh FROM.a TO.so.VERSION: make a shared library of the localised archive. It exports what the header
# declares, under the version of the interface, and its soname is its name.
set -eu

from=$1
to=$2
: "${CC:=cc}"
. tools/checks.sh

{
    echo "MSLIP_$abi { global:"
    declared include/microslip.h | sed 's/$/;/'
    echo 'local: *; };'
} > "$work/exports"

# Nothing may stay undefined but what the mathematical library and the C library have, and all is bound at the start: the
# first call in a computation takes no longer than the others.
$CC -shared -o "$to" -Wl,--whole-archive "$from" -Wl,--no-whole-archive -lm -Wl,-soname,"${to##*/}" \
    -Wl,--version-script="$work/exports" -Wl,-z,defs -Wl,-z,now
