#!/bin/sh
# release.sh [URL]: build all artefacts of a release from the last commit into target/publish, each tested as it is installed in a
# clean environment, with their SHA-256 sums. URL is the address that the source tarball will have. It takes half an hour or more.
set -eu
cd "$(dirname "$0")/.."
. tools/steps.sh

url=${1:-}
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml)
publish=$PWD/target/publish

committed() {
    git diff HEAD --stat --exit-code
}
# The reference is tested where it is unpacked.
reference() {
    site=microslip-$version-reference
    tools/docs.sh &&
        tar --create --directory target --transform "s,^docs,$site," --sort=name docs | gzip -9n > "$publish/$site.tar.gz" &&
        tar -xzf "$publish/$site.tar.gz" -C "$work" && python3 docs/reference/site.py "$work/$site"
}
collect() {
    cp "target/microslip-$version.tar.gz" "target/microslip-$version-windows-x86_64.zip" target/python/*.whl \
        target/aarch64-unknown-linux-gnu/python/*.whl "$publish" &&
        cp -R target/recipes "$publish" && (cd "$publish" && sha256sum ./*.* > SHA256SUMS && cat SHA256SUMS)
}

packages() {
    step 'source tarball, clients by each tool, shared library' tools/packages.sh
    step 'recipes of conda-forge and Spack; the conda package' env BUILD=1 tools/recipes.sh ${url:+"$url"}
    step 'fpm' tools/fpm.sh "$prefix"
    step 'reference of functions' reference
}
wheels_and_platforms() {
    step 'wheel, by every Python' tools/python.sh all every
    step 'aarch64: library, wheel' tools/aarch64.sh "$prefix"
    step 'shared library of other systems' tools/other_systems.sh
}

tools/dependencies.sh check release
step 'all is committed' committed
rm -rf "$publish"
mkdir -p "$publish"
step 'library: build, install, move' install_and_move
together packages wheels_and_platforms
step 'artefacts and their sums' collect
summary
echo "The artefacts are in $publish; packaging/RELEASE.md says what to do with them."
