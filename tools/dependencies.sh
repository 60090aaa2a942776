#!/bin/sh
# dependencies.sh GROUP...: check that the tools of each group are installed.
#
#   fortran   the Fortran compiler
#   demo      Fortran with LAPACK, and gnuplot
#   mpi       Fortran with LAPACK, Open MPI, and zlib
#   bench     the C compiler, and gnuplot
#   figures   gnuplot, GMP and MPFR
#   host      build dependencies of CalculiX, and gnuplot
#   fuzz      the C++ compiler
#   packages  build tools of clients, and Fortran with LAPACK
#   docs      the generator of the reference documentation
#   counting  counting instructions
#   guest     other compilers and linkers, sanitizers, valgrind
#   accuracy  GMP and MPFR
#   test      everything for `make test`
#
# Missing packages are installed if run as root on Debian or a derivative, and listed otherwise.
set -eu

missing=

# need PACKAGE COMMAND: the package with the command.
need() {
    command -v "$2" > /dev/null 2>&1 || missing="$missing $1"
}

# need_library PACKAGE NAME: the package with the library, as found by the Fortran compiler.
need_library() {
    for file in "lib$2.so" "lib$2.a"; do
        # The compiler prints the bare name if it does not find the file.
        [ "$(gfortran -print-file-name="$file" 2> /dev/null || echo "$file")" = "$file" ] || return 0
    done
    missing="$missing $1"
}

fortran() {
    need gfortran gfortran
}

demo() {
    fortran
    need_library liblapack-dev lapack
    need_library libblas-dev blas
    need gnuplot-nox gnuplot
}

mpi() {
    fortran
    need_library liblapack-dev lapack
    need_library libblas-dev blas
    need openmpi-bin mpirun
    need libopenmpi-dev mpifort
    need_library zlib1g-dev z
}

fuzz() {
    need g++ g++
}

counting() {
    need gcc gcc
    need binutils readelf
    need valgrind valgrind
}

# need_header PACKAGE NAME: the package with the header, as found by the C compiler.
need_header() {
    echo "#include <$2>" | gcc -E - > /dev/null 2>&1 || missing="$missing $1"
}

accuracy() {
    need gcc gcc
    need_header libgmp-dev gmp.h
    need_header libmpfr-dev mpfr.h
}

bench() {
    need gcc gcc
    need gnuplot-nox gnuplot
}

figures() {
    accuracy
    need gnuplot-nox gnuplot
}

# need_venv: Python's virtual environments, for tools that Debian does not package.
need_venv() {
    need python3 python3
    python3 -c 'import ensurepip' 2> /dev/null || missing="$missing python3-venv"
}

packages() {
    demo
    need gcc gcc
    need make make
    need cmake cmake
    need meson meson
    need ninja-build ninja
    need pkg-config pkg-config
    need_venv
}

docs() {
    need doxygen doxygen
    need_venv
}

host() {
    demo
    need gcc gcc
    need make make
    need dpkg-dev dpkg-source
    need_library libspooles-dev spooles
    need_library libarpack2-dev arpack
}

# need_clang PACKAGE OPTION: the package that clang needs to link with the option.
need_clang() {
    probe=$(mktemp)
    echo 'int main(void) { return 0; }' | clang "$2" -x c - -o "$probe" 2> /dev/null || missing="$missing $1"
    rm -f "$probe"
}

guest() {
    fortran
    need gcc gcc
    need g++ g++
    need clang clang
    need llvm llvm-symbolizer
    need_clang libclang-rt-dev -fsanitize=address,undefined
    need_clang libomp-dev -fopenmp
    need lld ld.lld
    need mold mold
    need valgrind valgrind
}

rust_component() {
    cargo "$2" --version > /dev/null 2>&1 || components="$components $1"
}

tests() {
    demo
    mpi
    counting
    guest
    fuzz
    accuracy
    packages
    need shellcheck shellcheck
    components=
    rust_component rustfmt fmt
    rust_component clippy clippy
    if [ -n "$components" ]; then
        if ! command -v rustup > /dev/null 2>&1; then
            echo "$0: install the Rust components$components" >&2
            exit 1
        fi
        # shellcheck disable=SC2086
        rustup component add $components
    fi
}

[ $# -gt 0 ] || {
    echo "usage: $0 fortran|demo|mpi|bench|figures|host|fuzz|counting|guest|accuracy|packages|docs|test..." >&2
    exit 2
}
for group in "$@"; do
    case $group in
        fortran | demo | mpi | bench | figures | host | fuzz | counting | guest | accuracy | packages | docs) "$group" ;;
        test) tests ;;
        *) echo "$0: no group $group" >&2; exit 2 ;;
    esac
done

[ -n "$missing" ] || exit 0
# shellcheck disable=SC2086
missing=$(printf '%s\n' $missing | sort -u | tr '\n' ' ')
if [ "$(id -u)" -eq 0 ] && command -v apt-get > /dev/null 2>&1; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -q
    # shellcheck disable=SC2086
    apt-get install -q -y --no-install-recommends $missing
else
    echo "$0: install these packages (Debian's names): $missing" >&2
    exit 1
fi
