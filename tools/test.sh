#!/usr/bin/env bash
# Builds the project with all warnings in build/release and runs its tests.
#
# usage: tools/test.sh [--sanitize] [--cross[=TARGET,…]] [--werror]
#
#   --sanitize   also build and run the tests under AddressSanitizer and UBSan (build/asan-ubsan)
#   --cross      also compare the golden scenes between processors, see tools/cross.sh
#                (default aarch64,s390x)
#   --werror     compiler warnings are errors
#   --help       print this
#
# Missing Debian packages are installed first (as root or through sudo). LOCKSTONE_JOBS bounds the
# number of parallel jobs. The last line says how many tests passed and failed.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

passed=0 failed=0 skipped=0
# What failed, said again at the end, where readers of a long log look first.
failures=$(mktemp)
trap 'rm -f "$failures"' EXIT

# count JUNIT-FILE TITLE: adds one test run's figures to the totals.
count() {
  local counts p f s
  counts=$(python3 -B tools/test_report.py "$1" "$2" "$failures")
  read -r p f s <<<"$counts"
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

# run_tests PRESET: runs all of them; a failing test does not end the script.
run_tests() {
  local report=$root/build/$1/tests.xml
  rm -f "$report"
  say "test $1"
  ctest --preset "$1" --parallel "$jobs" --output-junit "$report" || true
  [[ -s $report ]] || die "ctest ran no test of the preset $1"
  count "$report" "$1"
}

run_cross() {
  local output
  output=$(mktemp)
  if tools/cross.sh "$@" 2>&1 | tee "$output"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    { echo "-- failed: tools/cross.sh $*" && tail -40 "$output"; } >>"$failures"
  fi
  rm -f "$output"
}

sanitize=false
cross=()
options=()
for argument in "$@"; do
  case $argument in
    --sanitize) sanitize=true ;;
    --cross) cross=(aarch64 s390x) ;;
    --cross=*) IFS=, read -ra cross <<<"${argument#*=}" ;;
    --werror) options+=(-DLOCKSTONE_WARNINGS_AS_ERRORS=ON) ;;
    --help) usage; exit ;;
    *) usage >&2; exit 2 ;;
  esac
done

require_packages build assets
if "$sanitize"; then
  require_packages clang
  build_preset asan-ubsan
  run_tests asan-ubsan
fi
if ((${#cross[@]})); then run_cross "${cross[@]}"; fi
build_preset release "${options[@]}"
run_tests release

echo
cat "$failures"
((skipped == 0)) || echo "$skipped skipped"
echo "$passed passed, $failed failed"
((failed == 0))
