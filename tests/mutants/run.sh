#!/usr/bin/env bash
# Breaks the library in each way of list.txt (a sign, a term, a coefficient), rebuilds it, and runs the tests that must
# notice. Prints who killed whom; a mutant that ends its program by a crash or a time-out is said to. The exit code is 1
# when a mutant lives, or when an entry no longer fits the source.
# Works on a copy in build/mutants; some two hours on two cores.
#   tests/mutants/run.sh [--only TEXT] [FIRST [LAST]]   only these entries, counted from 1, of files whose paths hold TEXT
#   tests/mutants/run.sh --check   only whether every entry fits its source once; seconds, nothing is built
set -euo pipefail
cd "$(dirname "$0")/../.."
check= only=
if [ "${1:-}" = --check ]; then check=yes && shift; fi
if [ "${1:-}" = --only ]; then only=$2 && shift 2; fi
first=${1:-1}
last=${2:-1000000}
copy=build/mutants/tree
build=build/mutants/build
log=build/mutants/test.log

# The entries asked for, a column each.
files=() froms=() tos=() programs=() filters=() numbers=()
number=0
while IFS= read -r line; do
  case $line in
    '# '* | '') ;;
    '@ '*) file=${line#'@ '} ;;
    '- '*) from=${line#'- '} ;;
    '+ '*) to=${line#'+ '} ;;
    '= '*)
      number=$((number + 1))
      if ((number < first || number > last)) || [[ $file != *"$only"* ]]; then continue; fi
      read -r program filter <<<"${line#'= '}"
      files+=("$file") froms+=("$from") tos+=("$to") programs+=("$program") filters+=("$filter") numbers+=("$number")
      ;;
    *) echo "tests/mutants/list.txt: cannot read: $line" >&2 && exit 2 ;;
  esac
done <tests/mutants/list.txt
((${#files[@]} > 0)) || { echo "list.txt has no entry from $first to $last of files with '$only'" >&2; exit 2; }

# Replaces FROM by TO in a file; fails unless FROM stands there once.
mutate() { FROM=$2 TO=$3 perl -0pi -e '$n = s/\Q$ENV{FROM}\E/$ENV{TO}/g; END { exit($n == 1 ? 0 : 1) }' "$1"; }

if [ "$check" ]; then
  misfits=0
  scratch=$(mktemp)
  trap 'rm -f "$scratch"' EXIT
  for i in "${!files[@]}"; do
    cp "${files[i]}" "$scratch" && mutate "$scratch" "${froms[i]}" "${tos[i]}" || {
      echo "${files[i]}: does not fit once: ${froms[i]}"
      misfits=1
    }
  done
  exit $misfits
fi

. .cmake/packages.sh
need_packages "${core_packages[@]}" "${bind_packages[@]}" "${test_packages[@]}" "${runner_packages[@]}" "${npm_packages[@]}"
rm -rf "$copy"
mkdir -p "$copy"
# With the present time: what an earlier run has built is older, and built again.
git ls-files -z | xargs -0 tar c | tar xm -C "$copy"
cmake -S "$copy" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DTENDRIL_EXAMPLES=ON -DTENDRIL_TESTS=ON \
  -Wno-dev >/dev/null

make_tests() { cmake --build "$build" --target "$@" >build/mutants/build.log 2>&1; }
mapfile -t all < <(printf '%s\n' "${programs[@]}" | sort -u)
make_tests "${all[@]}" || { tail -20 build/mutants/build.log >&2; exit 2; }
for program in "${all[@]}"; do
  "$build/bin/$program" >"$log" 2>&1 || { echo "$program fails without any mutant" >&2; exit 2; }
done

# The test that was running when the program ended.
running() { sed -n 's/^\[ RUN      \] //p' "$log" | tail -1; }
# \param 1  the program's exit code
judge() {
  local failed
  failed=$(sed -n 's/^\[  FAILED  \] \([A-Za-z0-9_/]*\.[A-Za-z0-9_/]*\).*/\1/p' "$log" | head -1)
  case $1 in
    0) echo LIVES ;;
    124) echo "ended by a time-out in $(running)" ;;
    1) if [ -n "$failed" ]; then echo "killed by $failed"; else echo "LIVES: exit code 1, but no test failed"; fi ;;
    *) echo "ended by a crash (exit code $1) in $(running)" ;;
  esac
}

killed=0
ended=0
lives=0
for i in "${!files[@]}"; do
  file=${files[i]}
  cp "$file" "$copy/$file"
  if ! mutate "$copy/$file" "${froms[i]}" "${tos[i]}"; then
    verdict="DOES NOT FIT THE SOURCE ONCE"
  elif ! make_tests "${programs[i]}"; then
    verdict="DOES NOT BUILD"
  else
    code=0
    timeout 300 "$build/bin/${programs[i]}" --gtest_filter="${filters[i]}" >"$log" 2>&1 || code=$?
    verdict=$(judge "$code")
  fi
  case $verdict in
    killed*) killed=$((killed + 1)) ;;
    ended*) ended=$((ended + 1)) ;;
    *) lives=$((lives + 1)) ;;
  esac
  printf '%3d  %-28s  %-44.44s  %s\n' "${numbers[i]}" "$(basename "$file")" "${tos[i]}" "$verdict"
  cp "$file" "$copy/$file"
done
echo "$killed killed by a test, $ended ended by a crash or a time-out, $lives not"
((lives == 0))
