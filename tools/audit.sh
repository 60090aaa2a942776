#!/bin/sh
# audit.sh: licences, duplicates and sources of all dependencies, and what is known against them, by cargo-deny with deny.toml.
# If cargo-deny is missing, it is installed into target/tools, without optimisation: with its own, it takes minutes more.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
PATH=$PATH:$PWD/target/tools/bin

command -v cargo-deny > /dev/null 2>&1 ||
    "$CARGO" install --quiet --debug --locked --root target/tools --target-dir target/tools/build cargo-deny

. tools/checks.sh

subjects='licenses bans sources'
if cargo-deny fetch db > /dev/null 2>&1; then
    subjects="$subjects advisories"
else
    echo 'The database of advisories cannot be reached: advisories and withdrawn versions are NOT checked.'
fi
for subject in $subjects; do
    check "$subject" cargo-deny --workspace --locked --config deny.toml check "$subject"
done

counts
