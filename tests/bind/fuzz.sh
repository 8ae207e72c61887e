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
printf 'v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0.5\nf 1/1/1 2/1/1 -1/-1/-1\nf 1 2 \\\n3\n' >build/fuzz/corpus/a.obj
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n' \
  >build/fuzz/corpus/a.stl
{ head -c 80 /dev/zero && printf '\1\0\0\0' && head -c 50 /dev/zero; } >build/fuzz/corpus/b.stl
cd build/fuzz
exec bin/import_fuzz corpus -runs="$runs" -max_len=4096 -print_final_stats=1
