#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the program and runs the showcase scene.
#   examples/run.sh           writes out/ and prints where the picture is
set -euo pipefail
cd "$(dirname "$0")/.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${runner_packages[@]}"
bash .cmake/cgal-meshes.sh build/cgal-meshes
# A build folder keeps the choice whether tests are built; a new one needs none for this.
if [ -f build/CMakeCache.txt ]; then cmake --preset release -Wno-dev; else cmake --preset release -Wno-dev -DTENDRIL_TESTS=OFF; fi
cmake --build --preset release --target tendril
build/bin/tendril run examples/scenes/diplodocus.json --out out </dev/null

pictures=$(find out -name '*.png' | sort)
[ -n "$pictures" ] || { echo "the run wrote no picture into out/" >&2; exit 1; }
echo "pictures:"
while read -r picture; do echo "  $PWD/$picture"; done <<<"$pictures"
