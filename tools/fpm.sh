#!/bin/sh
# fpm.sh PREFIX: a client built by the Fortran package manager, with the installed module and archive. fpm
# is installed from PyPI into target/tools if it is missing; the exit status is 77 if that is not possible.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
. tools/checks.sh
pypi fpm fpm==0.12.0
PATH=$PWD/target/tools/fpm/bin:$PATH

mkdir -p "$work/client/app" "$work/client/src"
cp packaging/clients/fpm/fpm.toml "$work/client"
cp packaging/clients/client.f90 "$work/client/app/main.f90"
cp "$prefix/include/microslip.f90" "$work/client/src"
cd "$work/client"
fpm run --compiler "$FC" --link-flag "-L$prefix/lib"
