#!/bin/sh
# packages.sh: test every way to use the library from another project. A source tarball is built without a network and
# installed; clients in C and in Fortran are built with each build tool.
set -eu

cd "$(dirname "$0")/.."
. tools/checks.sh
export CC FC

clients=$PWD/packaging/clients
tree=$work/microslip-$version
static=$work/static

# Cargo has the crates of the tarball only, and no network if the system permits that.
mkdir "$work/cargo"
offline() {
    CARGO_HOME="$work/cargo" CARGO_NET_OFFLINE=true $isolated "$@"
}

tools/tarball.sh "$tree.tar.gz"
tar -xzf "$tree.tar.gz" -C "$work"
check 'the tarball can be built and installed without a network' offline make -C "$tree" install PREFIX="$static"
[ "$failed" -eq 0 ] || { counts; exit; }

check 'CHANGELOG.md has this version' grep -q "^## \[$version\]" CHANGELOG.md

# The README's two commands, from the tarball.
check 'tarball: make demo without a network' offline make -C "$tree" demo
crates_are_there() {
    (cd "$tree" && offline "$CARGO" metadata --locked --format-version 1)
}
check 'tarball: the crates of make test' crates_are_there
reproducible() {
    tools/tarball.sh "$work/again/microslip-$version.tar.gz" && cmp "$work/again/microslip-$version.tar.gz" "$tree.tar.gz"
}
check 'the tarball is reproducible' reproducible

# Clients of an installed copy.
make_client() { # PREFIX SHARED-LIBRARY
    rm -rf "$work/clients" && cp -R "$clients" "$work/clients" && make -C "$work/clients/make" PREFIX="$1" FC="$FC" CC="$CC" &&
        "$work/clients/make/client_c" && "$work/clients/make/client_fortran" && [ "$(needs "$work/clients/make/client_c")" = "$2" ]
}
check 'make' make_client "$static" ''
check 'pkg-config' clients "$static"
other_interface() {
    sed 's/\(MSLIP_MODULE_ABI_VERSION = \).*/\10/' "$static/include/microslip.f90" > "$work/other.f90" &&
        $FC -J "$work" "$work/other.f90" tests/fortran/checks.f90 tests/fortran/other_interface.f90 "$static/lib/libmicroslip.a" -lm \
            -o "$work/other" && "$work/other" | grep -x '4 passed, 0 failed'
}
check 'Fortran: a library of another interface is rejected' other_interface
readme_program() { # LANGUAGE COMPILER PREFIX SHARED-LIBRARY: the program in README.md, built with the commands in README.md
    rm -rf "$work/readme" && tools/snippets.sh README.md "$work/readme" &&
        mv "$work"/readme/snippet_*."$1" "$work/readme/first_contact.$1" &&
        { echo 'set -e'; grep -E "^(export PKG_CONFIG_PATH=|$2 )" README.md; } > "$work/readme/build.sh" &&
        (cd "$work/readme" && PREFIX=$3 sh build.sh && ./a.out) && [ "$(needs "$work/readme/a.out")" = "$4" ]
}
check 'README: gcc' readme_program c gcc "$static" ''
check 'README: gfortran' readme_program f90 gfortran "$static" ''
cmake_client() { # DIRECTORY NUMBER-OF-CLIENTS OPTION...; the name of the directory has a blank, which must not matter
    build=$work/cmake/$1
    number=$2
    shift 2
    cmake -S "$clients/cmake" -B "$build" -DCMAKE_Fortran_COMPILER="$FC" "$@" && offline cmake --build "$build" &&
        (cd "$build" && ctest --output-on-failure | tee ctest.log) && grep -q "tests passed.* out of $number\$" "$build/ctest.log"
}
rejected() {
    ! "$@"
}
for generator in Ninja 'Unix Makefiles'; do
    check "CMake: find_package, $generator" cmake_client "find package, $generator" 3 -G "$generator" -DCMAKE_PREFIX_PATH="$static"
done
check 'CMake: find_package, one Fortran target' cmake_client "one Fortran target" 2 -DFORTRAN_CLIENTS=1 \
    -DCMAKE_PREFIX_PATH="$static"
check 'CMake: another version is rejected' rejected cmake -S "$clients/cmake" -B "$work/cmake/other" -DMICROSLIP_VERSION=99 -DCMAKE_PREFIX_PATH="$static"
check 'CMake: find_package, no Fortran compiler' cmake_client "C only" 1 -DFORTRAN_CLIENTS=0 -DCMAKE_Fortran_COMPILER=false \
    -DCMAKE_PREFIX_PATH="$static"

# Clients that build the library as part of their own build. All but FetchContent, which tests the defaults, share the target
# directory of cargo with the tarball, so that it compiles once.
for generator in Ninja 'Unix Makefiles'; do
    check "CMake: add_subdirectory, $generator" cmake_client "add subdirectory, $generator" 3 -G "$generator" \
        -DMICROSLIP_SOURCE="$tree" -DMICROSLIP_CARGO_TARGET_DIR="$tree/target"
done
check 'CMake: add_subdirectory, no Fortran compiler' cmake_client "C only, add subdirectory" 1 -DFORTRAN_CLIENTS=0 \
    -DCMAKE_Fortran_COMPILER=false -DMICROSLIP_SOURCE="$tree" -DMICROSLIP_CARGO_TARGET_DIR="$tree/target"
check 'CMake: FetchContent' cmake_client "fetch content" 3 -DMICROSLIP_URL="$tree.tar.gz"
meson_client() {
    mkdir -p "$work/meson" && cp "$clients/client.c" "$clients/client.f90" "$clients/meson/meson.build" "$work/meson" &&
        PKG_CONFIG_PATH="$static/lib/pkgconfig" meson setup "$work/meson build" "$work/meson" &&
        meson test -C "$work/meson build" --print-errorlogs
}
check 'Meson' meson_client

# The shared library. Clients find it at run time by their rpath.
shared=$work/shared
so=libmicroslip.so.$abi
check 'the shared library can be installed' offline make -C "$tree" install PREFIX="$shared" SHARED=1
check 'symbols' tools/symbols.sh "$shared"
check 'pkg-config, shared library' clients "$shared" "$so"
check 'make, shared library' make_client "$shared" "$so"
check 'README: gcc, shared library' readme_program c gcc "$shared" "$so"
check 'README: gfortran, shared library' readme_program f90 gfortran "$shared" "$so"
examples() { # a relative prefix, seen from the directory of the examples
    programs=$tree/fortran_examples/build && make -C "$tree/fortran_examples" clean &&
        make -C "$tree/fortran_examples" short PREFIX=../../shared &&
        (cd / && "$programs/static_first") && [ "$(needs "$programs/forced_response")" = "$so" ]
}
check 'Fortran examples, shared library' examples
check 'CMake: clients of both libraries' cmake_client "both libraries" 4 -DCMAKE_PREFIX_PATH="$shared"
uninstall() {
    make -C "$tree" uninstall PREFIX="$shared" && [ -z "$(find "$shared" ! -type d)" ]
}
check 'uninstall removes all files' uninstall

counts
