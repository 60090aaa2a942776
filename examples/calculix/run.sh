#!/bin/sh
# run.sh PREFIX: builds CalculiX 2.20 from Debian's source package with the contact as its user element U1, runs the models,
# compares the results with the library, and rewrites the tables of static jobs and the figures in results/. PREFIX is the installation
# of microslip; everything else is in build/.
set -eu

prefix=$(cd "${1:?usage: run.sh PREFIX}" && pwd)
cd "$(dirname "$0")"
: "${FC:=gfortran}" "${CC:=gcc}" "${GNUPLOT:=gnuplot}" "${PYTHON:=python3}"
mkdir -p build results

# The source package on any Debian release: apt verifies its signature, with a source list of its own.
source=build/calculix-ccx-2.20/ccx_2.20/src
if [ ! -d "$source" ]; then
    apt=$PWD/build/apt
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main" \
        > "$apt/sources.list"
    set -- -q -o Dir::Etc::sourcelist="$apt/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$apt/lists" -o Dir::Cache="$apt/cache" -o APT::Sandbox::User=
    apt-get "$@" update
    (cd build && apt-get "$@" source calculix-ccx=2.20-1)
fi

# CalculiX as an archive, by its own makefile.
flags='-w -O1 -I/usr/include/spooles -DARCH=Linux -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1'
make -C "$source" ccx_2.20.a CC="$CC" FC="$FC" FFLAGS='-w -O1 -fallow-argument-mismatch' CFLAGS="$flags" > build/make.log 2>&1 ||
    { tail -n 20 build/make.log; exit 1; }

# Linked before the archive, these routines replace those of U1.
strict='-std=f2008 -Wall -Wextra -pedantic -Wno-unused-dummy-argument'
(
    cd build
    # shellcheck disable=SC2086
    {
        $CC $flags -c "../$source/ccx_2.20.c" -o main.o
        $FC -O2 -c "$prefix/include/microslip.f90" -o microslip.o
        $FC $strict -O2 -c ../../contact_point.f90 ../contact_element.f90
        $FC -fopenmp main.o contact_element.o contact_point.o microslip.o "../$source/ccx_2.20.a" "$prefix/lib/libmicroslip.a" \
            -lspooles -lpthread -larpack -llapack -lblas -lm -o ccx
    }
)

rm -rf build/jobs
mkdir build/jobs
cd build/jobs
../../model.sh

# job NAME: one run of CalculiX.
job() {
    ../ccx "$1" > "$1.log" 2>&1 || { tail -n 20 "$1.log"; exit 1; }
}

# table HEADER NAME: tip, displacement and force of the contact, m components by the header, energy; rounding errors as 0.
table() {
    echo "$1"
    awk -v m=$(($(echo "$1" | tr -cd , | wc -c) / 3)) '
         function append(first) { for (i = first; i < first + m; i++) line = line "," ($i^2 < 1e-20 ? 0 : $i) }
         / and time /               { time = $NF }
         NF == 4 && $1 == 113       { line = time; append(5 - m) }
         NF > 46 && $1 == 5000      { append(4 + m); append(3); print line "," $(3 + m) }' "$2.dat"
}

for name in frequency matrices lifting rejected lifting_dynamic orbit orbit_dynamic; do job "$name"; done
cp lifting.rout resumed.rin
job resumed
awk '$1 == 1 && NF == 5 { print $2; exit }' frequency.dat > ../../results/frequency.csv
header='time,tip_y,tip_z,displacement,approach,force,normal_force,dissipated'
table "$header" lifting > ../../results/lifting.csv
table "$header" resumed > resumed.csv
table "$header" rejected > rejected.csv
table "$header" lifting_dynamic > lifting_dynamic.csv
header='time,tip_x,tip_y,tip_z,displacement_u,displacement_v,approach,force_x,force_y,normal_force,dissipated'
table "$header" orbit > ../../results/orbit.csv
table "$header" orbit_dynamic > orbit_dynamic.csv
cp element.inp ../../results/

tail -n +2 resumed.csv > resumed.tail
tail -n "$(wc -l < resumed.tail)" ../../results/lifting.csv | cmp - resumed.tail ||
    { echo 'The results after a restart differ.'; exit 1; }
rejected=$(awk '$3 ~ /U$/' rejected.sta | wc -l)
[ "$rejected" -gt 0 ] || { echo 'No increment was rejected: that case is not tested.'; exit 1; }
echo "rejected increments: $rejected; the results after a restart are equal"

cd ../..
"$PYTHON" -m venv build/python
build/python/bin/pip install --quiet --force-reinstall ../../python
build/python/bin/python compare.py results build/jobs
"$GNUPLOT" figures.gp
