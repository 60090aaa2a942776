#!/bin/sh
# check.sh: what `make test` leaves out: lints, sanitizers, applications of every kind, fuzzing, Miri, coverage, packages, audit.
# shellcheck disable=SC2086  # lists
set -eu
cd "$(dirname "$0")/.."
: "${MICROSLIP_SEED:=$(date +%s)}"
. tools/steps.sh
echo "seed of the random tests: $MICROSLIP_SEED"

tools/dependencies.sh check

# The guide names the versions of the compilers that the tests use, on the system that it names.
compilers_named() {
    grep -q '^VERSION_ID="12"' /etc/os-release || return 0
    sentence=$(sed -n '/^Tested on Debian 12/,/^$/p' docs/guide.md | tr '\n' ' ')
    for compiler in "gfortran $(gfortran -dumpfullversion)" "clang $(clang -dumpversion)" "flang $($FC -dumpversion)"; do
        case $sentence in *"${compiler%.*}"*) ;; *) echo "docs/guide.md does not name ${compiler%.*}" && return 1 ;; esac
    done
}

rust() {
    step 'formatting' "$CARGO" fmt --all --check
    # Nothing is linked, so libFuzzer need not be compiled.
    step 'lints: Rust' env CUSTOM_LIBFUZZER_PATH=/libfuzzer.a "$CARGO" clippy --workspace --all-targets --locked -- -D warnings
    step 'lints: shell' sh -c 'git ls-files "*.sh" | xargs shellcheck --external-sources --source-path=SCRIPTDIR .ci/run'
    step 'coverage: 98 % of the lines of src/' tools/coverage.sh
    step 'accuracy and adversarial histories, 1e5 points' target/debug/verify --points 1e5
    step 'verdicts of 40 fits of each kind' env MICROSLIP_FITS=40 "$CARGO" test $workspace --test wrong_models -- plateau microslip
    step 'two directions: Jacobians of 10,000 random motions' env MICROSLIP_MOTIONS=10000 "$CARGO" test $workspace --test two_directions jacobians
    step 'random calls and histories' "$CARGO" test $workspace --test ffi --test histories
    step 'references of the interfaces' tools/docs.sh
}

installed() {
    step 'archive in calling applications' verification/embedding/embedding.sh "$prefix"
    step 'fuzzing, bounded' tools/fuzz.sh --check
    step 'Abaqus: user subroutines, compiled' make -C examples PREFIX="$prefix"
    step 'Octave and NLvib: the law in harmonic balance' make -C examples/nlvib test PREFIX="$prefix"
    step 'Fortran on threads' make -C fortran_examples parallel PREFIX="$prefix"
    step 'Miri' tools/miri.sh
    step 'benchmark, quick' make bench QUICK=1
    # All tests in Fortran, with another compiler.
    FC=flang-new-19 fc=flang-new-19
    step 'guide: the compilers' compilers_named
    step 'flang: tests of the module' env MICROSLIP_PREFIX="$prefix" "$CARGO" test $workspace --test c_drivers fortran
    # Debian's older one links with this option only.
    printf '#!/bin/sh\nexec flang-new-16 -flang-experimental-exec "$@"\n' > "$work/flang-16"
    chmod +x "$work/flang-16"
    step 'flang 16: tests of the module' env FC="$work/flang-16" MICROSLIP_PREFIX="$prefix" "$CARGO" test $workspace --test c_drivers fortran
    step 'flang: examples' make -C fortran_examples short PREFIX="$prefix"
    step 'flang: clients' clients "$prefix"
    programs_of_documents f90
}

packages() {
    step 'packages: source tarball, clients by each tool, shared library' tools/packages.sh
    step 'build: settings of cargo, make and the system' tools/settings.sh "$prefix"
    step 'packages: the compiled library for Linux' tools/linux.sh "$prefix" "$(uname -m)"
    step 'packages: recipes of conda-forge and Spack' tools/recipes.sh
    step 'packages: fpm' tools/fpm.sh "$prefix"
    step 'audit' tools/audit.sh
    step 'Python: wheel, versions, types, adapters, examples, documents' tools/python.sh all
}

step 'library: build, install, move' install_and_move
step 'tools: compiled' "$CARGO" build $workspace --bins
# Three on two processors: none is idle while one step waits for a lock, a download or its only thread.
together rust installed packages
summary
