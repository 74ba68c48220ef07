#!/usr/bin/env bash
# Builds the command with other engines beside ours (build/bench) and runs the benchmarks.
#
# usage: tools/bench.sh [--quick] [--docs] [BENCHMARK…]
#
# Benchmarks: speed queries rows numerics skip front; on demand accuracy stability size instructions.
#
#   --quick      below ten minutes, installing and building included, on four cores: fewer scenes,
#                ticks, questions and repeats
#   --docs       write charts, tables and counts into docs/benchmarks, not build/bench/results
#   --help       print this
#
# Missing Debian packages are installed first (as root or through sudo), and engines of the npm
# registry into build/bench/node. An engine that cannot be installed is reported as absent.
# LOCKSTONE_JOBS bounds the number of parallel compilers; the benchmarks themselves use one thread
# unless they compare several, so let nothing else run beside them. Where the engines under Node are
# there, ours is built for WebAssembly too, by Emscripten, to be timed beside them.
# The output of each benchmark is kept in a file NAME.txt beside charts and tables.

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
    front | speed | queries | rows | numerics | skip | accuracy | stability | size | instructions) benchmarks+=("$argument") ;;
    *) usage >&2; exit 2 ;;
  esac
done
((${#benchmarks[@]})) || benchmarks=(speed queries rows numerics skip front)

node=build/bench/node

# fetch_node: Emscripten, and the engines under Node.
fetch_node() {
  command -v npm >/dev/null || return 0
  (require_packages bench-wasm) || true
  mkdir -p "$node"
  cp tools/bench/peers/node/*.mjs tools/bench/peers/node/package.json "$node"
  npm install --prefix "$node" --no-audit --no-fund --silent || rm -f "$node/package.json"
}

# wasm_player: builds ours for Node and names the file; nothing without Emscripten.
wasm_player() {
  local folder=build/bench/wasm
  command -v em++ >/dev/null || return 0
  # Where Debian keeps the modules that Emscripten's linker needs: a Node from elsewhere looks not there.
  export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs
  say "build ours for WebAssembly"
  cmake --preset wasm -B "$folder" -DLOCKSTONE_SCENE_PLAYER=ON >/dev/null &&
    cmake --build "$folder" --target lockstone_scene_player --parallel "$jobs" >&2 || return 0
  echo "$folder/tools/bench/player/lockstone_scene_player"
}

# node_options: the options that name engines under Node to `lockstone`; nothing without them.
node_options() {
  local player
  command -v node >/dev/null && [[ -e $node/package.json ]] || return 0
  printf '%s\n' --node "$node"
  player=$(wasm_player)
  [[ -z $player ]] || printf '%s\n' --wasm "$player"
}

# arguments_of BENCHMARK: of `lockstone bench`, a line each.
arguments_of() {
  case $1 in
    front) printf '%s\n' accuracy --force --plot "$results"; node_options ;;
    accuracy) printf '%s\n' accuracy --force --sweep --page "$results/accuracy.md" ;;
    stability) printf '%s\n' stability --force --page "$results/stability.md" ;;
    speed)
      echo speed
      "$quick" || echo --detail
      ;;
    size) printf '%s\n' size --force --cpu --page "$results/size.md" --chart "$results/size.svg" ;;
    instructions) printf '%s\n' speed --force --instructions "$results/instructions.csv" ;;
    *) echo "$1" ;;
  esac
  "$quick" || return 0
  case $1 in
    front | queries) echo --quick ;;
    speed) printf '%s\n' --quick --threads 1 ;;
    accuracy) printf '%s\n' --tries 100 ;;
    stability) printf '%s\n' --seconds 5 ;;
    size) printf '%s\n' --most 10000 ;;
    rows | numerics) printf '%s\n' --repeats 7 ;;
  esac
}

require_packages demo build
# A peer that cannot be had is no reason to stop.
(require_packages bench) || true
# Fetching hardly needs a processor: meanwhile they build. Nothing is measured before both are done.
if [[ " ${benchmarks[*]} " == *" front "* ]]; then fetch_node >&2 & fi
build_preset bench
wait
mkdir -p "$results"

# A goal that is missed is reported, and the rest still runs.
code=0
took=("installing and building: $SECONDS s")
for benchmark in "${benchmarks[@]}"; do
  begun=$SECONDS
  mapfile -t arguments < <(arguments_of "$benchmark")
  say "lockstone bench ${arguments[*]}"
  build/bench/tools/lockstone bench "${arguments[@]}" | tee "$results/$benchmark.txt" || code=$?
  took+=("$benchmark: $((SECONDS - begun)) s")
done
say "$(printf '%s; ' "${took[@]}")all: $SECONDS s"
say "charts, tables and counts: $results"
exit "$code"
