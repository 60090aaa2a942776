#!/bin/sh
# dependencies.sh [--install] GROUP...: list the packages that a group of commands needs and that are missing. With --install, or
# if CI is true as in continuous integration, install them as root on Debian or a derivative, after a message that names them.
#
# A line of the table: package, groups, and how to recognise it (rust, command NAME, file NAME, library NAME for the linker,
# header NAME, clang OPTION). What another package of the table depends on has no line.
set -eu

# The oldest Rust that compiles the library.
rust=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$(dirname "$0")/../Cargo.toml")
table='
cargo           rust demo test check bench figures host fuzz docs verify python parallel : rust
gcc             demo test check bench figures host fuzz docs verify python   : command gcc
gfortran        demo test check host parallel                         : command gfortran
liblapack-dev   demo test check host parallel                         : library lapack
gnuplot-nox     demo check bench figures host                         : command gnuplot
libmpfr-dev     test check figures verify                             : header mpfr.h
pkg-config      test check                                            : command pkg-config
g++             test check fuzz                                       : command g++
shellcheck      check                                                 : command shellcheck
valgrind        check                                                 : command valgrind
clang           check                                                 : command clang
flang-19        check                                                 : command flang-new-19
flang-16        check                                                 : command flang-new-16
llvm            check                                                 : command llvm-symbolizer
libclang-rt-dev check                                                 : clang -fsanitize=address,undefined
lld             check                                                 : command ld.lld
mold            check                                                 : command mold
cmake           check                                                 : command cmake
meson           check                                                 : command meson
doxygen         check docs                                            : command doxygen
pandoc          check docs                                            : command pandoc
libjs-bootstrap5 check docs                                           : file /usr/share/javascript/bootstrap5
python3         bench figures host                                    : command python3
python3-venv    test check docs python host                           : command python3 -c "import ensurepip"
octave-dev      check octave                                          : command mkoctfile
dpkg-dev        host                                                  : command dpkg-source
libspooles-dev  host                                                  : library spooles
libarpack2-dev  host                                                  : library arpack
gfortran-aarch64-linux-gnu release                                    : command aarch64-linux-gnu-gfortran
qemu-user                  release                                    : command qemu-aarch64
gfortran-mingw-w64-x86-64  release                                    : command x86_64-w64-mingw32-gfortran
wine                       release                                    : command wine
'

# found KIND NAME [ARGUMENT...]
found() {
    case $1 in
        rust) "${CARGO:-cargo}" --version |
            awk -v rust="$rust" '{ split($2, v, "."); split(rust, r, "."); ok = v[1] > r[1] || (v[1] == r[1] && v[2] >= r[2] + 0) }
                END { exit !ok }' ;;
        command) command -v "$2" && { [ $# -eq 2 ] || { shift; "$@"; }; } ;;
        file) [ -e "$2" ] ;;
        header) echo "#include <$2>" | gcc -E - ;;
        # A compiler prints the bare name of a library that it does not find.
        library) gcc -print-file-name="lib$2.so" | grep / || gcc -print-file-name="lib$2.a" | grep / ;;
        clang) echo 'int main(void) { return 0; }' | clang "$2" -x c - -o /dev/null ;;
    esac > /dev/null 2>&1
}

[ "${1-}" != --install ] || { CI=true && shift; }
[ $# -gt 0 ] || { echo "usage: $0 [--install] GROUP... (demo, test, check, ...: see the table)" >&2; exit 2; }
missing=$(
    echo "$table" | while IFS=: read -r head probe; do
        package=${head%% *}
        for group in "$@"; do
            case " $head " in *" $group "*) eval "found $probe" || echo "$package" ;; esac
        done
    done | sort -u | tr '\n' ' '
)
[ -n "$missing" ] || exit 0
case $missing in *cargo*) note="cargo of Rust $rust or later, from your system or from https://rustup.rs" ;; *) note= ;; esac
if [ "${CI-}" != true ] || [ "$(id -u)" -ne 0 ] || ! command -v apt-get > /dev/null; then
    echo "$0: these packages are missing (Debian's names): $missing${note:+($note)}" >&2
    echo "install them, or run as root on Debian: $0 --install $*" >&2
    exit 1
fi
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
# Of a distribution whose cargo is older, cargo-web is the newer one, for browsers.
if [ -n "$note" ]; then
    missing=${missing#cargo }
    for package in cargo cargo-web; do
        version=$(apt-cache policy $package | sed -n 's/^ *Candidate: //p')
        ! dpkg --compare-versions "${version:-0}" ge "$rust" || { missing="$package $missing" && break; }
    done
fi
echo "$0: installing by apt-get: $missing"
# shellcheck disable=SC2086  # a list
apt-get install -qq -y --no-install-recommends $missing
[ -z "$note" ] || found rust || { echo "$0: missing: $note" >&2; exit 1; }
