#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds and runs the experiments of the thesis beside what it compares with.
#   examples/gallery.sh                 writes out/gallery/index.html and gallery.json
#   examples/gallery.sh --only 4.1      one figure alone, into out/gallery/4.1
set -euo pipefail
cd "$(dirname "$0")/.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${runner_packages[@]}"
# A build folder keeps the choice whether tests are built; a new one needs none for this.
if [ -f build/CMakeCache.txt ]; then cmake --preset release -Wno-dev; else cmake --preset release -Wno-dev -DTENDRIL_TESTS=OFF; fi
cmake --build --preset release --target tendril_gallery
out=out/gallery
if [ "${1:-}" = --only ]; then out=$out/${2:?the number of a figure, as 4.1}; fi
build/bin/tendril_gallery --out "$out" "$@" </dev/null
