#!/bin/sh
# instrumented.sh RUSTC ARGUMENTS...: the compiler, with counters of coverage; cargo's workspace wrapper in coverage.sh.
exec "$@" -Cinstrument-coverage
