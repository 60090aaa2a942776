#!/bin/sh
# docs.sh: the references of the C interface, the Fortran module and the Rust functions, into target/docs. What has no
# comment, and what is not understood, is an error. FORD comes from PyPI, into target/tools.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
MSLIP_VERSION=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml)
export MSLIP_VERSION
out=target/docs
ford=target/tools/ford
passed=0
failed=0

# made NAME COMMAND...
made() {
    name=$1
    shift
    if "$@" > "$out/$name.log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        cat "$out/$name.log"
        echo "The reference of $name is not made, or not complete."
    fi
}

fortran() {
    $ford/bin/python -c 'import ford' 2> /dev/null ||
        { python3 -m venv $ford && $ford/bin/pip install --quiet --disable-pip-version-check ford==7.0.13; } || return 1
    $ford/bin/python docs/reference/fortran.py docs/reference/ford.md && ! grep -q 'Warning' $out/Fortran.log
}

rust() {
    RUSTDOCFLAGS='-D warnings' $CARGO doc --quiet --no-deps --locked --package microslip --target-dir target/docs/rust-build &&
        cp -R $out/rust-build/doc $out/rust
}

rm -rf $out
mkdir -p $out
made C doxygen docs/reference/Doxyfile
made Fortran fortran
made Rust rust
rm -rf $out/rust-build

cat > $out/index.html << END
<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>microslip $MSLIP_VERSION</title></head>
<body>
<h1>microslip $MSLIP_VERSION</h1>
<ul>
<li><a href="c/index.html">The C interface</a></li>
<li><a href="fortran/index.html">The Fortran module</a></li>
<li><a href="rust/microslip/index.html">The Rust functions</a></li>
</ul>
</body>
</html>
END

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
