#!/bin/sh
# recipes.sh [URL]: recipes of conda-forge and Spack into target/recipes, for a source tarball that is or will be published at URL (by
# default the file itself). They are checked with Python and with rattler-build from PyPI; where it cannot be installed the status
# is 77. BUILD=1 also builds and tests the conda package, with the compilers of this machine.
set -eu

cd "$(dirname "$0")/.."
. tools/checks.sh

tarball=$PWD/target/microslip-$version.tar.gz
url=${1:-file://$tarball}
recipes=target/recipes
tools=target/tools/recipes

pypi recipes py-rattler-build==0.73.0 ruamel.yaml

tools/tarball.sh "$tarball"
sum=$(sha256sum "$tarball" | cut -d ' ' -f 1)
for recipe in conda/recipe.yaml spack/package.py; do
    mkdir -p "$recipes/$(dirname $recipe)"
    sed "s|@VERSION@|$version|; s|@URL@|$url|; s|@SHA256@|$sum|" packaging/$recipe.in > $recipes/$recipe
done

check 'conda-forge: the recipe is rendered' $tools/bin/python packaging/conda/render.py $recipes/conda/recipe.yaml
[ -z "${BUILD:-}" ] ||
    check 'conda-forge: the package is built and passes its tests' \
        $tools/bin/python packaging/conda/render.py $recipes/conda/recipe.yaml "$work/conda" "$tarball"
check 'Spack: the package is valid Python' $tools/bin/python -c 'compile(open("target/recipes/spack/package.py").read(), "package.py", "exec")'
counts
