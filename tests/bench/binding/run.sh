#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the bench of bindings, projections, readers and judges and runs it on one thread;
# some minutes. The exit code is the bench's: 1 when a result is wrong, never for being slow.
#   tests/bench/binding/run.sh [--quick] [--json FILE] [--only update|transpose|projection|reading|tree|judging]
set -euo pipefail
cd "$(dirname "$0")/../../.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" nlohmann-json3-dev \
  libocct-modeling-algorithms-dev libocct-modeling-data-dev libocct-foundation-dev libsisl-dev
bash .cmake/cgal-meshes.sh build/cgal-meshes
cmake -S . -B build/bench_binding -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENDRIL_BENCH=ON -DTENDRIL_EXAMPLES=OFF -DTENDRIL_SCENE=OFF \
  -DTENDRIL_TESTS=ON -Wno-dev >/dev/null
cmake --build build/bench_binding --target binding_bench
exec build/bench_binding/bin/binding_bench build/cgal-meshes "$@"
