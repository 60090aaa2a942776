#!/bin/sh
# python.sh [all [every]]: test the Python package from its source, with the library that the daily tests compile. `all` builds the
# wheel to be published and tests it installed in a clean environment, by the oldest and the newest other Python that are found too
# (`every`: by all of them), and tests types, format, adapters, examples and the programs of the documents.
# PYTHON= is the interpreter. With TARGET=aarch64-unknown-linux-gnu the wheel is that to be published for this processor, tested
# by QEMU and Debian's Python for it, without the rights of root. Build and test tools come from PyPI, into target/tools: among them
# Zig, whose linker makes wheels for any Linux with glibc 2.17 or later (manylinux2014).
set -eu

cd "$(dirname "$0")/.."
: "${PYTHON:=python3}"
tools=$PWD/target/tools/python
target=${TARGET:-}
wheels=$PWD/target${target:+/$target}/python
package=$PWD/python
PIP_DISABLE_PIP_VERSION_CHECK=1
PIP_QUIET=1
export PIP_DISABLE_PIP_VERSION_CHECK PIP_QUIET
. tools/checks.sh

# A wheel is built from the crates of Cargo.lock without a network.
# shellcheck disable=SC2086  # a list
wheel() {
    rm -rf "$wheels" && { "$CARGO" fetch --locked --offline || "$CARGO" fetch --locked; } &&
        (cd python && PATH="$tools/bin:$PATH" CARGO_NET_OFFLINE=true $isolated \
            maturin build --release --zig --compatibility manylinux2014 ${target:+--target $target} --out "$wheels") &&
        "$PYTHON" -m zipfile -e "$wheels/microslip-$version-py3-none-"*.whl "$work/wheel"
}
licences() {
    tools/notices.sh check && for file in LICENSE-APACHE LICENSE-MIT THIRD-PARTY.md; do
        cmp "python/$file" "$work/wheel/microslip-$version.dist-info/licenses/$file" || return
    done
}
# Without cargo, pip fetches no Rust but says what is missing.
without_cargo() {
    ! PATH="$work/python/bin" pip install ./python > "$work/pip" 2>&1 && grep 'microslip is built by cargo' "$work/pip"
}
# environment DIRECTORY PYTHON PACKAGE...: a clean one with the wheel.
environment() {
    directory=$1
    "$2" -m venv "$directory" && shift 2 && "$directory/bin/pip" install "$wheels"/*.whl pytest "$@"
}
# emulated_environment DIRECTORY: the same for TARGET. Debian's packages are unpacked, not installed.
emulated_environment() {
    root=$PWD/target/tools/python-$target
    apt=$work/apt
    [ -x "$root/usr/bin/python3" ] || {
        mkdir -p "$root" "$apt/state/lists/partial" "$apt/cache/archives/partial" &&
            printf '%s;\n' 'APT::Architecture "arm64"' 'APT::Architectures { "arm64"; }' "Dir::State \"$apt/state\"" \
                "Dir::Cache \"$apt/cache\"" 'Dir::State::status "/dev/null"' 'Debug::NoLocking "true"' > "$apt/apt.conf" &&
            APT_CONFIG="$apt/apt.conf" apt-get -q update && APT_CONFIG="$apt/apt.conf" apt-get -q install -y --download-only \
                --no-install-recommends python3-minimal libpython3-stdlib libstdc++6 &&
            for archive in "$apt"/cache/archives/*.deb; do dpkg -x "$archive" "$root" || return; done
    } || return
    version_of_python=$(readlink "$root/usr/bin/python3") && version_of_python=${version_of_python#python}
    "$tools/bin/pip" install --target "$1/site" --only-binary :all: --python-version "$version_of_python" --implementation cp \
        --platform manylinux_2_28_aarch64 --platform manylinux2014_aarch64 "$wheels"/*.whl cffi numpy pytest && mkdir -p "$1/bin" &&
        for program in python pytest; do
            module=
            [ $program = python ] || module='-m pytest'
            printf '#!/bin/sh\nexport PYTHONPATH=%s PYTHONHOME=%s\nexec qemu-%s -L %s %s %s "$@"\n' "$1/site" "$root/usr" \
                "${target%%-*}" "$root" "$root/usr/bin/python3" "$module" > "$1/bin/$program" && chmod +x "$1/bin/$program" || return
        done
}
# tests NAME DIRECTORY ARGUMENT...: counts the tests of pytest.
tests() {
    name=$1 directory=$2
    shift 2
    (cd "$work" && "$directory/bin/pytest" -q -p no:cacheprovider -c "$package/pyproject.toml" "$@") > "$work/pytest" 2>&1 ||
        tail -n 60 "$work/pytest"
    good=$(sed -n 's/^\(.* \)\{0,1\}\([0-9]*\) passed.*/\2/p' "$work/pytest" | tail -n 1)
    bad=$(sed -n 's/^\([0-9]*\) failed.*/\1/p; s/.* \([0-9]*\) error.*/\1/p' "$work/pytest" | tail -n 1)
    [ -n "$good$bad" ] || bad=1
    passed=$((passed + ${good:-0}))
    failed=$((failed + ${bad:-0}))
    echo "$name: ${good:-0} passed, ${bad:-0} failed"
}

# core DIRECTORY: the tests that need nothing but the wheel; by QEMU, not the arguments, which Python checks.
core() {
    tests "tests, $("$1/bin/python" --version)" "$1" ${target:+-k 'not test_arguments'} \
        "$package"/tests/test_interface.py "$package"/tests/test_arguments.py "$package"/tests/test_tables.py \
        "$package"/tests/test_fit.py
}

# In a wheel, maturin writes the module _native.
package() {
    export PYTHONPATH="$work"
    "$CARGO" build --locked --workspace --exclude microslip-fuzz --lib && "$PYTHON" -m venv "$work/python" &&
        "$work/python/bin/pip" install cffi numpy pytest 'tomli; python_version < "3.11"' && cp -R python/microslip "$work" &&
        printf 'import cffi\nffi = cffi.FFI()\nffi.cdef(open("%s/header.h").read())\nlib = ffi.dlopen("%s/debug/libmicroslip_python.so")\n' \
            "$PWD/target" "$PWD/target" > "$work/microslip/_native.py"
}

if [ "${1:-}$target" = '' ]; then
    check 'package' package
    core "$work/python"
    counts
    exit
fi
check 'build tools' pypi python 'maturin>=1.9.2,<2' 'cffi>=1.15' ziglang
check 'wheel' wheel
[ "$failed" -eq 0 ] || { counts; exit; }
check 'licences in the wheel' licences
check 'the wheel needs glibc 2.17 at most' glibc "$work/wheel/microslip/_native/"*.so
if [ -n "$target" ]; then
    check "environment of $target" emulated_environment "$work/python"
    core "$work/python"
    counts
    exit
fi
check "clean environment" environment "$work/python" "$PYTHON"
check 'pip install ./python without cargo' without_cargo
core "$work/python"
[ "${1:-}" = all ] || { counts; exit; }
check 'CalculiX: its results are those of the library' "$work/python/bin/python" examples/calculix/compare.py examples/calculix/results

# others [every]: the oldest and the newest interpreter, or every one, of pyenv or on PATH, that can make environments
# and is another than PYTHON.
others() {
    for minor in 9 10 11 12 13 14; do
        for candidate in $(command -v python3.$minor) "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor".*/bin/python3; do
            if "$candidate" -c "import ensurepip, sys; sys.exit(sys.version_info[1] != $minor)" 2> /dev/null; then
                [ "$minor" -eq "$("$PYTHON" -c 'import sys; print(sys.version_info[1])')" ] || echo "$candidate"
                break
            fi
        done
    done | if [ "${1:-}" = every ]; then cat; else sed -n '1p; $p' | uniq; fi
}
for other in $(others "${2:-}"); do
    check "clean environment, $("$other" --version)" environment "$work/other" "$other"
    core "$work/other"
    rm -rf "$work/other"
done
from_source() {
    "$PYTHON" -m venv "$work/source" && "$work/source/bin/pip" install ./python &&
        (cd "$work" && source/bin/python -c 'import microslip')
}
check 'pip install ./python' from_source
# Kept, because they are many. pyHarm names Jupyter among its requirements, a hundred packages that it does not need.
adapters=$PWD/target/tools/python-adapters
examples() {
    { "$adapters/bin/ruff" --version && "$adapters/bin/pip" show exudyn || {
        "$PYTHON" -m venv "$adapters" && "$adapters/bin/pip" install --no-deps pyHarm-os==1.2.2 && "$adapters/bin/python" -c '
from importlib.metadata import requires
kept = [r.replace(" ", "") for r in requires("pyHarm-os") if not r.startswith(("notebook", "nbformat"))]
print(*kept, sep="\n")' > "$work/required" &&
            "$adapters/bin/pip" install -r "$work/required" psutil matplotlib jax mypy==2.4.1 pytest ruff==0.17.6 exudyn==1.13.6
    }; } && "$adapters/bin/pip" install --force-reinstall --no-deps "$wheels"/*.whl && "$adapters/bin/pip" install cffi numpy
}
check 'packages of the examples' examples
types() {
    (cd "$work" && "$adapters/bin/mypy" --config-file "$package/pyproject.toml" -p microslip)
}
check 'types' types
check 'format' "$adapters/bin/ruff" format --check python
check 'lints' "$adapters/bin/ruff" check python
tests 'adapters and examples' "$adapters" \
    "$package"/tests/test_tmdsimpy.py "$package"/tests/test_pyharm.py "$package"/tests/test_jax.py \
    "$package"/tests/test_exudyn.py \
    "$package"/tests/test_documents.py
counts
