#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds and tests. The exit code is ctest's.
#   tests/run.sh              the short tests
#   tests/run.sh --long       the long ones too, and the benches compiled
#   tests/run.sh --sanitize   in a build with the address and undefined-behaviour sanitizers
#   tests/run.sh --thread     the programs that use threads, in a build with the thread sanitizer
#   tests/run.sh --shared     with shared libraries
#   tests/run.sh --clang      with clang, which must be there
set -euo pipefail
cd "$(dirname "$0")/.."
preset=release
labels='^short$'
targets=() benches=()
for argument in "$@"; do
  case $argument in
    --long) labels='^(short|long)$' targets=(--target all long) benches=(-DTENDRIL_BENCH=ON) ;;
    --sanitize) preset=sanitize ;;
    --shared | --clang) preset=${argument#--} ;;
    --thread) preset=thread labels='^threads$' targets=(--target threads) ;;
    *) sed -n '2,8s/^# //p' "$0" >&2; exit 2 ;;
  esac
done

. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" "${runner_packages[@]}" "${npm_packages[@]}"
if [[ $labels == *long* ]]; then need_packages "${player_packages[@]}"; fi
bash .cmake/cgal-meshes.sh build/cgal-meshes
bash .cmake/npm.sh tests/runner/films build/npm
# The consumer tests compile the same sources in folders of their own; a first compilation is not preprocessed twice.
export CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1
# With the long tests the benches are compiled, so that they keep up with the library. From nothing all compiles the
# fast way; a folder that a person works in stays as it is.
options=(-DTENDRIL_TESTS=ON "${benches[@]}")
folder=build/$preset
if [ "$preset" = release ]; then folder=build; fi
if [ ! -e "$folder/CMakeCache.txt" ]; then options+=(-DTENDRIL_UNITY=ON); fi
cmake --preset "$preset" -Wno-dev "${options[@]}"
cmake --build --preset "$preset" "${targets[@]}"
ctest --preset "$preset" --label-regex "$labels" --parallel "$(nproc)" --no-tests=error </dev/null
