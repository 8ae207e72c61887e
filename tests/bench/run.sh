#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the bench and runs it on one thread; some minutes. The exit code is the
# bench's: 1 when a result is wrong, never for being slow.
#   tests/bench/run.sh [--quick] [--json FILE] [--only rhs|wind|growth|plant|mujoco|stiff]
set -euo pipefail
cd "$(dirname "$0")/../.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${test_packages[@]}" nlohmann-json3-dev \
  libsundials-dev libsuitesparse-dev libmujoco-dev
cmake -S . -B build/bench -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENDRIL_BENCH=ON -DTENDRIL_BIND=OFF \
  -DTENDRIL_EXAMPLES=OFF -DTENDRIL_SCENE=OFF -DTENDRIL_TESTS=ON -Wno-dev >/dev/null
cmake --build build/bench --target dynamics_bench
exec build/bench/bin/dynamics_bench "$@"
