#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the bench of collision tests and runs it on one thread; about a minute. The
# exit code is the bench's: 1 when a result is wrong, never for being slow.
#   tests/bench/collision/run.sh [--quick] [--json FILE] [--only triangles]
set -euo pipefail
cd "$(dirname "$0")/../../.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" nlohmann-json3-dev libfcl-dev
cmake -S . -B build/bench_collision -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENDRIL_BENCH=ON -DTENDRIL_EXAMPLES=OFF \
  -DTENDRIL_TESTS=ON -Wno-dev >/dev/null
cmake --build build/bench_collision --target collision_bench
exec build/bench_collision/bin/collision_bench "$@"
