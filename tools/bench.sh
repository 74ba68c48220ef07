#!/usr/bin/env bash
# Builds the command with other engines beside ours (build/bench) and runs the benchmarks.
#
# usage: tools/bench.sh [--quick] [BENCHMARK…]      default: speed queries rows numerics
#
#   --quick      a minute instead of many: fewer ticks, questions and repeats
#   --help       print this
#
# Missing Debian packages are installed first (as root or through sudo). An engine that cannot be
# installed is reported as absent. LOCKSTONE_JOBS bounds the number of parallel compilers; the
# benchmarks themselves use one thread, so let nothing else run beside them.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

quick=false
benchmarks=()
for argument in "$@"; do
  case $argument in
    --quick) quick=true ;;
    --help) usage; exit ;;
    speed | queries | rows | numerics) benchmarks+=("$argument") ;;
    *) usage >&2; exit 2 ;;
  esac
done
((${#benchmarks[@]})) || benchmarks=(speed queries rows numerics)

# options_of BENCHMARK: what it is run with.
options_of() {
  case $1 in
    speed) echo --detail; if "$quick"; then echo --quick; fi ;;
    queries) if "$quick"; then echo --quick; fi ;;
    rows | numerics) if "$quick"; then printf '%s\n' --repeats 7; fi ;;
  esac
}

require_packages build
# A peer that cannot be had is no reason to stop.
(require_packages bench) || true
build_preset bench

for benchmark in "${benchmarks[@]}"; do
  mapfile -t options < <(options_of "$benchmark")
  say "lockstone bench $benchmark ${options[*]-}"
  build/bench/tools/lockstone bench "$benchmark" ${options[@]+"${options[@]}"}
done
