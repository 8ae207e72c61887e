#!/usr/bin/env bash
# Breaks the library in each way of list.txt (a sign, a term, a coefficient), rebuilds it, and runs the tests that must
# notice. Prints who killed whom; the exit code is 1 when a mutant lives, or when an entry no longer fits the source.
# Works on a copy in build/mutants; half an hour or so on two cores.
#   tests/mutants/run.sh [FIRST [LAST]]     only these entries, counted from 1
#   tests/mutants/run.sh --check            only whether every entry fits its source once; seconds, nothing is built
set -euo pipefail
cd "$(dirname "$0")/../.."

# Replaces FROM by TO in a file; fails unless FROM stands there once.
mutate() { FROM=$2 TO=$3 perl -0pi -e '$n = s/\Q$ENV{FROM}\E/$ENV{TO}/g; END { exit($n == 1 ? 0 : 1) }' "$1"; }

if [ "${1:-}" = --check ]; then
  misfits=0
  scratch=$(mktemp)
  trap 'rm -f "$scratch"' EXIT
  while IFS= read -r line; do
    case $line in
      '@ '*) file=${line#'@ '} ;;
      '- '*) from=${line#'- '} ;;
      '= '*) cp "$file" "$scratch" && mutate "$scratch" "$from" "" || { echo "$file: does not fit once: $from" && misfits=1; } ;;
    esac
  done <tests/mutants/list.txt
  exit $misfits
fi

. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}"
first=${1:-1}
last=${2:-1000000}
copy=build/mutants/tree
build=build/mutants/build
rm -rf "$copy"
mkdir -p "$copy"
# With the present time: what an earlier run has built is older, and built again.
git ls-files -z | xargs -0 tar c | tar xm -C "$copy"

programs=(accuracy_test dynamics_test guard_test statics_test box_tree_test triangles_test shapes_test surface_test hostile_test)
make_tests() { cmake --build "$build" --target "${programs[@]}" >build/mutants/build.log 2>&1; }
cmake -S "$copy" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DTENDRIL_BIND=OFF \
  -DTENDRIL_EXAMPLES=OFF -DTENDRIL_TESTS=ON -Wno-dev >/dev/null
make_tests
for program in "${programs[@]}"; do
  "$build/bin/$program" >build/mutants/test.log 2>&1 || { echo "$program fails without any mutant" >&2; exit 2; }
done

number=0
lives=0
killed=0
try() {
  local file=$1 from=$2 to=$3 program=$4 filter=$5 verdict
  number=$((number + 1))
  if ((number < first || number > last)); then return; fi
  cp "$file" "$copy/$file"
  if ! mutate "$copy/$file" "$from" "$to"; then
    verdict="DOES NOT FIT THE SOURCE ONCE"
  elif ! make_tests; then
    verdict="DOES NOT BUILD"
  elif timeout 300 "$build/bin/$program" --gtest_filter="$filter" >build/mutants/test.log 2>&1; then
    verdict=LIVES
  else
    verdict="killed by $(sed -n 's/^\[  FAILED  \] \([A-Za-z/]*\.[A-Za-z/]*\).*/\1/p' build/mutants/test.log | head -1)"
  fi
  case $verdict in killed*) killed=$((killed + 1)) ;; *) lives=$((lives + 1)) ;; esac
  printf '%3d  %-28s  %-44.44s  %s\n' "$number" "$(basename "$file")" "$to" "$verdict"
  cp "$file" "$copy/$file"
}

while IFS= read -r line; do
  case $line in
    '# '* | '') ;;
    '@ '*) file=${line#'@ '} ;;
    '- '*) from=${line#'- '} ;;
    '+ '*) to=${line#'+ '} ;;
    '= '*) read -r program filter <<<"${line#'= '}" && try "$file" "$from" "$to" "$program" "$filter" ;;
    *) echo "tests/mutants/list.txt: cannot read: $line" >&2 && exit 2 ;;
  esac
done <tests/mutants/list.txt
echo "$killed killed, $lives not"
((lives == 0))
