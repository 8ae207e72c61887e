#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the fuzzer of the mesh readers with the address and undefined-behaviour
# sanitizers and gives it RUNS inputs (10^7 when not said: a quarter of an hour on one core). Fails on the first
# finding, and leaves it in build/fuzz.
#   tests/bind/fuzz.sh [RUNS]
set -euo pipefail
cd "$(dirname "$0")/../.."
runs=${1:-10000000}
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" clang libclang-rt-14-dev
cmake -S . -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_CXX_FLAGS="-O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all" \
  -DTENDRIL_FUZZ=ON -DTENDRIL_TESTS=ON -DTENDRIL_EXAMPLES=OFF -DTENDRIL_SCENE=OFF -DTENDRIL_AXIS=OFF -Wno-dev >/dev/null
cmake --build build/fuzz --target import_fuzz
mkdir -p build/fuzz/corpus
cp tests/examples/box.off build/fuzz/corpus/
cd build/fuzz
exec bin/import_fuzz corpus -runs="$runs" -max_len=4096 -print_final_stats=1
