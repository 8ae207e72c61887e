#!/usr/bin/env bash
# Whether two builds of the program give the same bits: every example scene, run by both.
#   tests/examples/same_bits.sh BASE_PROGRAM [PROGRAM]      PROGRAM: build/bin/tendril
# What BASE_PROGRAM wrote is kept in ${BASE_OUT:-a temporary folder} and used again when it is there.
set -euo pipefail
tree=$(cd "$(dirname "$0")/../.." && pwd)
base=$1 program=${2:-$tree/build/bin/tendril}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
kept=${BASE_OUT:-$work/base}

# run PROGRAM SCENE FOLDER: what the program writes and says, without wall times.
run() {
  mkdir -p "$3"
  local code=0
  "$1" run "$2" --out "$3/out" --threads 1 --json >"$3/said" 2>"$3/error" || code=$?
  echo "$code" >"$3/code"
  sed -i '/"wall_s"/,/}/d' "$3/said" "$3/out/summary.json"
}

cd "$tree/examples/scenes"
differ=0
for scene in *.json; do
  name=${scene%.json}
  [ -e "$kept/$name/code" ] || run "$base" "$scene" "$kept/$name"
  run "$program" "$scene" "$work/now/$name"
  if diff -rq "$kept/$name" "$work/now/$name"; then echo "$name: the same"; else differ=1; fi
done
exit $differ
