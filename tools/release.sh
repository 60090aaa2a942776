#!/bin/sh
# release.sh [URL]: build all artefacts of a release from the last commit into target/publish, each tested as it is installed in a
# clean environment, with their SHA-256 sums. URL is the address that the source tarball will have. It takes half an hour or more.
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

url=${1:-}
publish=$PWD/target/publish

committed() {
    git diff HEAD --stat --exit-code
}
# Of the toolchain that this directory uses.
standard_libraries() {
    for triple in aarch64-unknown-linux-gnu x86_64-pc-windows-gnu aarch64-apple-darwin x86_64-apple-darwin; do
        [ -d "$(rustc --print target-libdir --target $triple)" ] || rustup target add $triple || return
    done
}
# The reference is tested where it is unpacked.
reference() {
    site=microslip-$version-reference
    tools/docs.sh && cp -R target/docs "$work/$site" && pack "$site" && rm -r "${work:?}/$site" &&
        tar -xzf "target/$site.tar.gz" -C "$work" && python3 docs/reference/site.py "$work/$site"
}
collect() {
    cp target/microslip-"$version"[.-]* target/python/*.whl target/aarch64-unknown-linux-gnu/python/*.whl "$publish" &&
        cp -R target/recipes "$publish" && (cd "$publish" && sha256sum -- *.* > SHA256SUMS && cat SHA256SUMS)
}

packages() {
    step 'source tarball, clients by each tool, shared library' tools/packages.sh
    step 'recipes of conda-forge and Spack; the conda package' env BUILD=1 tools/recipes.sh ${url:+"$url"}
    step 'fpm' tools/fpm.sh "$prefix"
    step 'reference of functions' reference
}
wheels_and_platforms() {
    step 'wheel, by every Python' tools/python.sh all every
    step 'wheel for aarch64' env TARGET=aarch64-unknown-linux-gnu tools/python.sh
    step 'Linux on aarch64' tools/linux.sh "$prefix" aarch64
    for cpu in x86-64 x86-64-v3; do
        step "Linux on $cpu" tools/linux.sh "$prefix" x86_64 $cpu
    done
    step 'Windows and macOS' tools/other_systems.sh "$prefix"
}

tools/dependencies.sh check release
step 'all is committed' committed
step 'Rust for other systems' standard_libraries
rm -rf "$publish" target/microslip-*
mkdir -p "$publish"
step 'library: build, install, move' install_and_move
together packages wheels_and_platforms
step 'artefacts and their sums' collect
summary
echo "The artefacts are in $publish; packaging/RELEASE.md says what to do with them."
