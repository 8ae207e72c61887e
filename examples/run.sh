#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds the program, makes a scene of a mesh and runs it.
#   examples/run.sh           writes out/ and prints where the pictures and the player are
set -euo pipefail
cd "$(dirname "$0")/.."
. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${runner_packages[@]}" "${npm_packages[@]}"
bash .cmake/cgal-meshes.sh build/cgal-meshes
# A build folder keeps its choices; a new one needs no tests for this, and compiles the fast way.
new=()
[ -f build/CMakeCache.txt ] || new=(-DTENDRIL_TESTS=OFF -DTENDRIL_UNITY=ON)
export CCACHE_DEPEND=1  # nothing is preprocessed twice
cmake --preset release -Wno-dev "${new[@]}"
cmake --build --preset release --target tendril
mkdir -p out
build/bin/tendril rig build/cgal-meshes/diplodocus.off --size 1.5 --wind 12 --out out/scene.json --picture out/rig.png </dev/null
player=(--player)
grep -q '^TENDRIL_HAS_PLAYER:INTERNAL=ON$' build/CMakeCache.txt || player=()  # npm fetched nothing: the rest is here
build/bin/tendril run out/scene.json --out out "${player[@]}" </dev/null

pictures=$(find out -name '*.png' | sort)
[ -n "$pictures" ] || { echo "the run wrote no picture into out/" >&2; exit 1; }
echo "pictures:"
while read -r picture; do echo "  $PWD/$picture"; done <<<"$pictures"
if [ ${#player[@]} -gt 0 ]; then
  echo "to play in a browser:"
  echo "  $PWD/out/scene.html"
fi
