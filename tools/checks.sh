# shellcheck shell=sh
# shellcheck disable=SC2034,SC2154  # for the scripts that source this one, in the root of the source, and of them
# checks.sh, to be sourced: `check NAME COMMAND...` runs a check, `counts` prints the last line and returns the status of the
# script. $work is a temporary directory. Commands of several steps are functions that join them by &&: `set -e` is ignored there.

: "${CARGO:=cargo}" "${CC:=gcc}" "${FC:=gfortran}"
export CARGO
# Of programs that are run by $emulator, if they are for another processor or system.
cc=$CC fc=$FC emulator=
unset MAKEFLAGS MFLAGS MAKELEVEL # not those of a make that runs the script
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml)
abi=$(sed -n 's/^#define MSLIP_ABI_VERSION //p' include/microslip.h)
# A namespace without a network, if the system permits that.
isolated=
if unshare -rn true 2> /dev/null; then isolated='unshare -rn'; fi

# The output of a command is shown if it fails.
check() {
    name=$1
    shift
    if "$@" > "$work/log" 2>&1; then
        passed=$((passed + 1))
        echo "passed: $name"
    else
        failed=$((failed + 1))
        echo "FAILED: $name"
        tail -n 40 "$work/log" | sed 's/^/    /'
    fi
}

counts() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}

# The functions of a header.
declared() {
    sed 's,//.*,,' "$1" | tr '\n' ' ' | grep -o 'mslip_[a-z0-9_]* *(' | tr -d ' (' | sort
}

# pypi NAME PACKAGE...: packages from PyPI, in the environment target/tools/NAME; if they cannot be installed, the script ends with 77.
pypi() {
    environment=target/tools/$1
    shift
    [ "$(cat "$environment/packages" 2> /dev/null)" = "$*" ] || {
        "${PYTHON:-python3}" -m venv "$environment" && "$environment/bin/pip" install --quiet --disable-pip-version-check "$@" &&
            echo "$*" > "$environment/packages"
    } || { echo "$* cannot be installed from PyPI" && exit 77; }
}

# pack DIRECTORY [TO]: target/DIRECTORY.tar.gz, or another file, of $work/DIRECTORY. The same files of a commit make the same bytes.
pack() {
    tar --create --directory "$work" --sort=name --mtime="@$(git log -1 --format=%ct)" --owner=0 --group=0 --numeric-owner \
        --mode=u+rw,go=rX "$1" | gzip -9n > "${2:-target/$1.tar.gz}"
}

# glibc LIBRARY: it needs no symbol version newer than that of glibc 2.17.
glibc() {
    readelf --wide --dyn-syms "$1" | grep -o 'GLIBC_[0-9.]*' > "$work/versions" &&
        [ "$({ cat "$work/versions" && echo GLIBC_2.17; } | sort -V | tail -n 1)" = GLIBC_2.17 ]
}

# clients PREFIX [SHARED-LIBRARY]: clients in C and in Fortran of an installed copy, with the flags of pkg-config; the shared library
# of microslip that they load.
# shellcheck disable=SC2046,SC2086  # lists
clients() {
    export PKG_CONFIG_PATH="$1/lib/pkgconfig" && [ "$(pkg-config --modversion microslip)" = "$version" ] &&
        $cc packaging/clients/client.c -o "$work/client_c" $(pkg-config --cflags --libs --static microslip) &&
        $fc -J "$work" "$1/include/microslip.f90" packaging/clients/client.f90 -o "$work/client_fortran" \
            $(pkg-config --libs --static microslip) && for program in "$work/client_c" "$work/client_fortran"; do
        [ "$(needs "$program")" = "${2:-}" ] && env LD_LIBRARY_PATH="$1/lib" $emulator "$program" || return
    done
}
needs() {
    readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(libmicroslip.*\)\]/\1/p'
}

# drivers LIBRARY DRIVER...: drivers in C and Fortran, with this library, report no failed check.
# shellcheck disable=SC2086  # lists
drivers() {
    library=$1
    shift
    for driver; do
        case $driver in
            *.c) $cc -O1 -Iinclude "c_tests/$driver" "$library" -lm -o "$work/driver.exe" ;;
            *) $fc -J "$work" -static include/microslip.f90 tests/fortran/checks.f90 "tests/fortran/$driver" "$library" -lm \
                -o "$work/driver.exe" ;;
        esac && $emulator "$work/driver.exe" --trap | tail -n 5 | tr -d '\r' | tee "$work/report" &&
            tail -n 1 "$work/report" | grep -qx '[1-9][0-9]* passed, 0 failed' || return
    done
}

# page SYSTEM FILE: the programs and the commands of docs/without-rust.md for Linux or Windows, with this compiled package, in an
# empty directory. The first command unpacks it.
page() {
    unpacked=${2##*/} && unpacked=${unpacked%.tar.gz} && unpacked=${unpacked%.zip} && rm -rf "$work/page" &&
        tools/snippets.sh docs/without-rust.md "$work/page" && cp "$2" "$work/page" &&
        cat > "$work/commands" << END
set -e
gcc() { command $cc "\$@"; }
gfortran() { command $fc "\$@"; }
case $2 in *.zip) tar() { python3 -m zipfile -e "\$2" .; } ;; esac
$(sed -n "/^## $1/,/^## /{/^\`\`\`sh/,/^\`\`\`/p}" docs/without-rust.md | sed "/^\`/d; s/microslip-$version-[a-z0-9_-]*/$unpacked/; s,^\./,$emulator &,")
END
        (cd "$work/page" && mv snippet_01.c first.c && mv snippet_02.f90 first.f90 && sh "$work/commands" | tr -d '\r' > output &&
            cat snippet_*.txt | diff - output)
}
