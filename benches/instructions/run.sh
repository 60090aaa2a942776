#!/bin/sh
# run.sh [OPTION...]: count the instructions of each call under callgrind and check the relations between the counts.
# OPTIONs go to gungraun: --save-baseline=NAME and --baseline=NAME compare two builds.
set -eu
cd "$(dirname "$0")/../.."
: "${CARGO:=cargo}"
tools=$PWD/target/tools
version=$(sed -n 's/^gungraun = "=\([0-9.]*\)".*/\1/p' benches/instructions/Cargo.toml)

# A debug build: the runner only starts valgrind and reads its output. Cargo skips it if this version is installed.
"$CARGO" install --quiet --debug --locked --root "$tools" --target-dir target/tools/build "gungraun-runner@$version"

output=$PWD/target/instructions/counts
mkdir -p "$output"
rm -f "$output/relations"
export GUNGRAUN_HOME="$output" GUNGRAUN_RUNNER="$tools/bin/gungraun-runner"
status=0
"$CARGO" bench --quiet --locked --profile dev --package instructions -- --nosummary "$@" || status=1
cat "$output/relations" || echo '0 passed, 1 failed'
exit "$status"
