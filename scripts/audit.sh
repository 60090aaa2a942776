#!/bin/sh
# audit.sh: licences, duplicates and sources of all dependencies, and what is known against them, by cargo-deny with
# deny.toml, for each workspace of this repository. cargo-deny is installed into target/tools where there is none,
# which takes minutes.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
PATH=$PATH:$PWD/target/tools/bin

command -v cargo-deny > /dev/null 2>&1 ||
    "$CARGO" install --quiet --locked --root target/tools --target-dir target/tools/build cargo-deny

passed=0
failed=0
check() { # CHECK MANIFEST
    if cargo-deny --manifest-path "$2" --locked --config deny.toml check "$1"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
    fi
}

checks='licenses bans sources'
if cargo-deny fetch db > /dev/null 2>&1; then
    checks="$checks advisories"
else
    echo 'The database of advisories cannot be reached: advisories and withdrawn versions are NOT checked.'
fi
for manifest in Cargo.toml */Cargo.toml; do
    grep -q '^\[workspace\]' "$manifest" || continue # a member is checked with its workspace
    echo "$manifest"
    for check in $checks; do
        check "$check" "$manifest"
    done
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
