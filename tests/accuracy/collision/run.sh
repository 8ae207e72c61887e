#!/usr/bin/env bash
# Installs what is missing (Debian 12), peers included, builds the collision accuracy suite and runs it; collision/ACCURACY.md
# says what its options and its output mean. The exit code is the suite's: 1 when an answer of tendril is wrong.
#   tests/accuracy/collision/run.sh [--out FOLDER] [--count N] [--data FOLDER] ...
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/../../.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" "${runner_packages[@]}" "${accuracy_packages[@]}"
cmake -S . -B build/accuracy -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENDRIL_TESTS=ON -Wno-dev >/dev/null
cmake --build build/accuracy --target tendril_accuracy
program=$PWD/build/accuracy/bin/tendril_accuracy
cd "$here"
exec "$program" "$@"
