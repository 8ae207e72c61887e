#!/usr/bin/env bash
# The benches of an older commit beside those of this tree, row by row: builds both with the same options, runs them in
# turns (old, new, new, old, ...) and prints new over old. CPU times on one thread. The exit code is 1 when a row is
# slower than the bound by both of bench_compare's figures, or missing; compare.cpp says how it judges. A section with such
# a row is run again, three times at most, and judged by all its runs: on a machine that others use, a few are not enough.
#   tests/bench/compare.sh BASE [--new BUILD] [--rounds N] [--bound X] [--whole] [--only SECTION]...
#     BASE       a commit, or a build folder that holds bin/dynamics_bench and bin/binding_bench
#     --new      a build folder of this tree with TENDRIL_BENCH=ON, which is brought up to date; else one is made
#     --rounds   pairs of runs of each section (5)
#     --bound    1.05
#     --whole    the benches' whole lists of problems, not the --quick ones; an hour and more
#     --only     rhs growth plant stiff, update transpose projection reading; several may be given
# Keeps its builds in build/compare. With the quick lists a round takes a minute or two, most of it in stiff's peers.
set -euo pipefail
cd "$(dirname "$0")/../.."
usage() { sed -n '6,12s/^# //p' "$0" >&2; exit 2; }
base='' new='' rounds=5 bound=1.05 size=--quick sections=()
while [ $# -gt 0 ]; do
  case $1 in
    --new | --rounds | --bound | --only) [ $# -gt 1 ] || usage ;;&
    --new) new=$2 && shift ;;
    --rounds) rounds=$2 && shift ;;
    --bound) bound=$2 && shift ;;
    --only) sections+=("$2") && shift ;;
    --whole) size= ;;
    -*) usage ;;
    *) [ -z "$base" ] && base=$1 || usage ;;
  esac
  shift
done
[ -n "$base" ] || usage
[ ${#sections[@]} -gt 0 ] || sections=(rhs growth plant stiff update transpose projection reading)

. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" nlohmann-json3-dev
bash .cmake/cgal-meshes.sh build/cgal-meshes
work=build/compare
mkdir -p "$work"
export CCACHE_NOHASHDIR=1

# build TREE FOLDER TARGETS...
build() {
  cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENDRIL_BENCH=ON -DTENDRIL_TESTS=ON -DTENDRIL_EXAMPLES=OFF \
    -DTENDRIL_SCENE=OFF -DTENDRIL_AXIS=OFF -DTENDRIL_COLLISION=OFF -Wno-dev >/dev/null
  cmake --build "$2" --target "${@:3}" >"$2/build.log" 2>&1 || { tail -20 "$2/build.log" >&2; exit 2; }
}
if [ "$new" ]; then
  cmake --build "$new" --target dynamics_bench binding_bench bench_compare >/dev/null
else
  new=$work/new
  build . "$new" dynamics_bench binding_bench bench_compare
fi
if [ -x "$base/bin/dynamics_bench" ]; then
  old=$base
else
  commit=$(git rev-parse --verify --quiet "$base^{commit}") || { echo "$base: no commit and no build" >&2; exit 2; }
  old=$work/${commit:0:12}
  if [ ! -e "$old/tree" ]; then
    mkdir -p "$old/unpacked" && git archive "$commit" | tar x -C "$old/unpacked" && mv "$old/unpacked" "$old/tree"
  fi
  build "$old/tree" "$old" dynamics_bench binding_bench
fi

# run BUILD SECTION FILE: the benches say 1 when a result is wrong, and that is not the question here.
run() {
  local program=("$1/bin/dynamics_bench")
  case $2 in update | transpose | projection | reading) program=("$1/bin/binding_bench" build/cgal-meshes) ;; esac
  "${program[@]}" $size --only "$2" --json "$3" >/dev/null || [ $? -eq 1 ]
  [ -e "$3" ] || { echo "$1: section $2 gives no figures" >&2; exit 2; }
}
# again SECTION FROM TO: pairs of runs
again() {
  local order side round
  for ((round = $2; round <= $3; round++)); do
    order=("$old old" "$new new")
    if ((round % 2 == 0)); then order=("$new new" "$old old"); fi
    for side in "${order[@]}"; do run "${side% *}" "$1" "$times/$1/${side##* }/$round.json"; done
  done
}
compare() { "$new/bin/bench_compare" "$bound" "$times/$1/old" "$times/$1/new"; }

times=$work/times
export TMPDIR=$work/tmp  # where the bench of readers puts its files
rm -rf "$times" "$TMPDIR"
mkdir -p "$TMPDIR"
for section in "${sections[@]}"; do
  mkdir -p "$times/$section/old" "$times/$section/new"
  again "$section" 1 "$rounds"
  for ((batch = 2; batch <= 4; batch++)); do
    if compare "$section" >/dev/null; then break; fi
    again "$section" $((rounds * (batch - 1) + 1)) $((rounds * batch))
  done
done
slower=0
for section in "${sections[@]}"; do
  echo "== $section =="
  compare "$section" || slower=1
done
exit $slower
