#!/usr/bin/env bash
# Builds the project with all warnings in build/release and runs its tests.
#
# usage: tools/test.sh [--sanitize] [--fuzz[=SECONDS]] [--cross[=TARGET,…]] [--explore [SECONDS]]
#                      [--browser] [--bindings] [--werror] [--unity]
#
# The tests do the same in every run: their seeds are listed (tests/support/random.h and
# listed_seeds.txt). LOCKSTONE_TEST_SEED gives them another.
#
#   --sanitize   also build and run the tests under AddressSanitizer and UBSan (build/asan-ubsan)
#   --fuzz       also run the libFuzzer program of every parser, from its corpus, under both
#                sanitizers (build/fuzz, default 30 s each)
#   --cross      also compare the golden scenes between processors, see tools/cross.sh
#                (default aarch64,s390x)
#   --browser    also test WebAssembly in headless Chromium, see tools/web.sh brief
#   --explore    also run the tests that draw from a seed with new ones (default 60 s), after all
#                others. Its findings are counted in a line of their own and printed with the
#                command that repeats it; the status is then 3, if nothing else failed
#   --bindings   also test the bindings of Rust and C#, whose compilers are installed. Without it they are
#                tested where the compilers are there already
#   --werror     compiler warnings are errors
#   --unity      compile batches of files: a build from nothing takes less time, a build after an edit
#                more. Of core only files that programs link together or not at all: others they link singly
#   --help       print this
#
# Missing Debian packages are installed first (as root or through sudo). LOCKSTONE_JOBS bounds the
# number of parallel jobs (of tests: one more). The last line says how many tests passed and failed.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

passed=0 failed=0 skipped=0
# The failures, printed again at the end, where readers of a long log look first.
failures=$(mktemp)
trap 'rm -f "$failures"' EXIT

# count JUNIT-FILE TITLE: adds one test run's figures to the totals.
count() {
  local counts p f s
  counts=$(python3 -B tools/test_report.py "$1" "$2" "$failures")
  read -r p f s <<<"$counts"
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

# run_tests PRESET: runs all of them; a failing test does not end the script. A tenth of the tests' time is
# spent waiting for a clock or a peer (demo_test for 40 s), so one test more than processors keeps those busy.
run_tests() {
  local report=$root/build/$1/tests.xml
  rm -f "$report"
  say "test $1"
  ctest --preset "$1" --parallel "$((jobs + 1))" --output-junit "$report" \
    --test-output-size-passed 1000000 --test-output-size-failed 1000000 || true
  [[ -s $report ]] || die "ctest ran no test of the preset $1"
  count "$report" "$1"
}

# run_script SCRIPT ARGUMENT…: counts as one test.
run_script() {
  local output
  output=$(mktemp)
  if "$@" 2>&1 | tee "$output"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    { echo "-- failed: $*" && tail -40 "$output"; } >>"$failures"
  fi
  rm -f "$output"
}

# run_fuzzers SECONDS: each from its corpus and its good examples. Nothing is written to the corpus.
run_fuzzers() {
  local name found output
  for name in $(fuzzers); do
    found=$(mktemp -d)
    output=$(mktemp)
    build/fuzz/tests/fuzz/"fuzz_$name" --seeds "$found"
    mkdir -p "$found/corpus"
    say "fuzz $name for $1 s"
    if (cd "$found" && "$root/build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$1" \
      -print_final_stats=1 . "$(corpus_of "$name" "$found")") >"$output" 2>&1; then
      passed=$((passed + 1))
      grep -E 'number_of_executed_units|new_units_added' "$output" >&2 || true
    else
      failed=$((failed + 1))
      tail -n 30 "$output" >&2
    fi
  done
}

# fuzzers: the parsers' names.
fuzzers() {
  local file
  for file in tests/fuzz/*_target.cpp; do basename "$file" _target.cpp; done
}

# explore SECONDS: new seeds for the tests of the release build that have just run.
explored=
explore() {
  local tests output
  tests=$(mktemp) output=$(mktemp)
  say "explore new seeds for $1 s"
  ctest --preset release --show-only=json-v1 >"$tests"
  python3 -B tools/explore_seeds.py --tests "$tests" --report build/release/tests.xml \
    --seconds "$1" --jobs "$jobs" | tee "$output" || true
  explored=$(tail -n 1 "$output")
  if [[ $explored != explore:*' 0 findings' ]]; then cat "$output" >>"$failures"; fi
  [[ $explored == explore:* ]] || failed=$((failed + 1))  # it did not come to its end
  rm -f "$tests" "$output"
}

# corpus_of NAME EMPTY-FOLDER: the folder of its corpus, if it has one.
corpus_of() {
  if [[ -d $root/tests/fuzz/corpus/$1 ]]; then echo "$root/tests/fuzz/corpus/$1"; else echo "$2/corpus"; fi
}

sanitize=false
fuzz_seconds=0
explore_seconds=0
bindings=false
browser=false
cross=()
options=()
while (($#)); do
  argument=$1
  shift
  case $argument in
    --sanitize) sanitize=true ;;
    --fuzz) fuzz_seconds=30 ;;
    --fuzz=*) fuzz_seconds=${argument#*=} ;;
    --cross) cross=(aarch64 s390x) ;;
    --cross=*) IFS=, read -ra cross <<<"${argument#*=}" ;;
    --explore)
      explore_seconds=60
      if [[ ${1-} =~ ^[0-9]+$ ]]; then explore_seconds=$1 && shift; fi ;;
    --browser) browser=true ;;
    --bindings) bindings=true ;;
    --werror) options+=(-DLOCKSTONE_WARNINGS_AS_ERRORS=ON) ;;
    --unity) options+=(-DLOCKSTONE_UNITY_BUILD=SESSION) ;;
    --help) usage; exit ;;
    *) usage >&2; exit 2 ;;
  esac
done

sections=(demo build assets)
if "$bindings"; then sections+=(bindings); fi
if "$sanitize" || ((fuzz_seconds)); then sections+=(clang); fi
if "$browser"; then
  sections+=(web-brief)
  command -v chromium >/dev/null || sections+=(web-brief-browser)
fi
require_packages "${sections[@]}"
if "$sanitize"; then
  build_preset asan-ubsan
  run_tests asan-ubsan
fi
if ((fuzz_seconds)); then
  mapfile -t build_targets < <(fuzzers | sed 's/^/fuzz_/')
  build_preset fuzz
  build_targets=()
  run_fuzzers "$fuzz_seconds"
fi
if ((${#cross[@]})); then run_script tools/cross.sh "${cross[@]}"; fi
build_preset release "${options[@]}"
run_tests release
if "$browser"; then run_script tools/web.sh brief; fi
if ((explore_seconds)); then explore "$explore_seconds"; fi

echo
cat "$failures"
((skipped == 0)) || echo "$skipped skipped"
if [[ -n $explored ]]; then echo "$explored"; fi
echo "$passed passed, $failed failed"
((failed == 0)) || exit 1
[[ -z $explored || $explored == *' 0 findings' ]] || exit 3
