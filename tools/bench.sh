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
# so let nothing else run beside them. Where Emscripten is installed, ours is also built for
# WebAssembly, to be timed beside the engines under Node; with --quick only when that was done before.

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

# wasm_options: what tells `lockstone` of ours under Node; nothing without Emscripten.
wasm_options() {
  local folder=build/bench/wasm
  local player=$folder/tools/bench/player/lockstone_scene_player.js
  if ! "$quick" && command -v em++ >/dev/null; then
    cmake --preset wasm -B "$folder" -DLOCKSTONE_SCENE_PLAYER=ON >/dev/null &&
      cmake --build "$folder" --target lockstone_scene_player --parallel "$jobs" >&2
  fi
  [[ ! -e $player ]] || printf '%s\n' --wasm "$player"
}

# node_options: what tells `lockstone` of engines under Node; nothing without them.
node_options() {
  local folder=build/bench/node
  command -v node >/dev/null && command -v npm >/dev/null || return 0
  mkdir -p "$folder"
  cp tools/bench/peers/node/*.mjs tools/bench/peers/node/package.json "$folder"
  npm install --prefix "$folder" --no-audit --no-fund --silent >&2 || return 0
  printf '%s\n' --node "$folder"
  wasm_options
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
