#!/usr/bin/env bash
# Builds the command with other engines beside ours (build/bench) and runs the benchmarks.
#
# usage: tools/bench.sh [--quick] [--docs] [BENCHMARK…]
#
# Benchmarks: front speed queries rows numerics skip instructions; all but the last by default.
#
#   --quick      minutes instead of an hour: fewer scenes, ticks, questions and repeats
#   --docs       write charts, tables and counts into docs/benchmarks, not build/bench/results
#   --help       print this
#
# Missing Debian packages are installed first (as root or through sudo), and engines of the npm
# registry into build/bench/node. An engine that cannot be installed is reported as absent.
# LOCKSTONE_JOBS bounds the number of parallel compilers; the benchmarks themselves use one thread,
# so let nothing else run beside them. LOCKSTONE_WASM names the lockstone.js of a WebAssembly build
# with benchmarks, to be timed beside the engines under Node.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

quick=false
results=build/bench/results
benchmarks=()
for argument in "$@"; do
  case $argument in
    --quick) quick=true ;;
    --docs) results=docs/benchmarks ;;
    --help) usage; exit ;;
    front | speed | queries | rows | numerics | skip | instructions) benchmarks+=("$argument") ;;
    *) usage >&2; exit 2 ;;
  esac
done
((${#benchmarks[@]})) || benchmarks=(speed queries rows numerics skip front)

# node_options: what tells `lockstone` of engines under Node; nothing without them.
node_options() {
  local folder=build/bench/node
  command -v node >/dev/null && command -v npm >/dev/null || return 0
  mkdir -p "$folder"
  cp tools/bench/peers/node/*.mjs tools/bench/peers/node/package.json "$folder"
  npm install --prefix "$folder" --no-audit --no-fund --silent >&2 || return 0
  printf '%s\n' --node "$folder"
  [[ -z ${LOCKSTONE_WASM-} ]] || printf '%s\n' --wasm "$LOCKSTONE_WASM"
}

# arguments_of BENCHMARK: of `lockstone bench`, a line each.
arguments_of() {
  case $1 in
    front) printf '%s\n' accuracy --plot "$results"; node_options ;;
    speed) printf '%s\n' speed --detail ;;
    instructions) printf '%s\n' speed --instructions "$results/instructions.csv" ;;
    *) echo "$1" ;;
  esac
  "$quick" || return 0
  case $1 in
    front | speed | queries) echo --quick ;;
    rows | numerics) printf '%s\n' --repeats 7 ;;
  esac
}

require_packages build
# A peer that cannot be had is no reason to stop.
(require_packages bench) || true
build_preset bench
mkdir -p "$results"

# A goal that is missed is reported, and the rest still runs.
code=0
for benchmark in "${benchmarks[@]}"; do
  mapfile -t arguments < <(arguments_of "$benchmark")
  say "lockstone bench ${arguments[*]}"
  build/bench/tools/lockstone bench "${arguments[@]}" || code=$?
done
say "charts, tables and counts: $results"
exit "$code"
