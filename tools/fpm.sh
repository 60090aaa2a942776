#!/bin/sh
# fpm.sh PREFIX: a client built by the Fortran package manager, with the installed module and archive. fpm
# is installed from PyPI into target/tools if it is missing; the exit status is 77 if that is not possible.
set -eu

prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
: "${FC:=gfortran}"
PATH=$PATH:$PWD/target/tools/fpm/bin

if ! command -v fpm > /dev/null && ! { python3 -m venv target/tools/fpm &&
    target/tools/fpm/bin/pip install --quiet --disable-pip-version-check fpm==0.12.0; }; then
    echo 'fpm cannot be installed from PyPI'
    exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/client/app" "$work/client/src"
cp packaging/clients/fpm/fpm.toml "$work/client"
cp packaging/clients/client.f90 "$work/client/app/main.f90"
cp "$prefix/include/microslip.f90" "$work/client/src"
cd "$work/client"
fpm run --compiler "$FC" --link-flag "-L$prefix/lib"
