#!/usr/bin/env bash
# Hashes one recorded match on several processors, under qemu where it must, and compares them: the steps of
# .github/workflows/match-hashes.yml on this machine, for a game of your own.
#
# usage: tools/ci/cross_hashes.sh [OPTION…] [TARGET…]     default targets: native aarch64 s390x
#
#   --source DIR   the game's CMake project, which finds lockstone (default: tools/examples/rolling)
#   --tool NAME    the target that builds its tool (default: rolling)
#   --log FILE     the match (default: one of bots, recorded by the native tool)
#   --flip TARGET  a negative control: this target goes wrong by one bit at tick 100
#
# Targets: native, aarch64, riscv64, armhf, s390x, i386 (tools/cmake/toolchains). The files go to
# build/match-hashes: TARGET.json and TARGET.states, and the table. Exits 1 when a hash differs. Missing
# Debian packages are installed first (as root or through sudo). LOCKSTONE_JOBS bounds the parallel jobs.

here=$PWD  # lib.sh goes to the root
# shellcheck source=../lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

source_dir=$root/tools/examples/rolling
tool=rolling
log=
flip=
targets=()
while (($#)); do
  case $1 in
    --help) usage; exit ;;
    --source) source_dir=$(cd "$here" && realpath "$2"); shift ;;
    --tool) tool=$2; shift ;;
    --log) log=$(cd "$here" && realpath "$2"); shift ;;
    --flip) flip=$2; shift ;;
    -*) usage >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done
((${#targets[@]})) || targets=(native aarch64 s390x)

# emulator_of TARGET: nothing for this machine.
emulator_of() {
  case $1 in
    native | i386) ;;
    armhf) echo qemu-arm ;;
    *) echo "qemu-$1" ;;
  esac
}

# toolchain_of TARGET: CMake's option.
toolchain_of() {
  [[ $1 == native ]] || echo "-DCMAKE_TOOLCHAIN_FILE=$root/tools/cmake/toolchains/$1.cmake"
}

out=$root/build/match-hashes

# build TARGET: installs Lockstone for it, then builds the game against the package.
build() {
  local target=$1 folder=$out/build/$1 options
  mapfile -t options < <(toolchain_of "$target")
  say "build $target"
  cmake -S . -B "$folder/lockstone" -G Ninja "${options[@]}" -DCMAKE_BUILD_TYPE=Release \
    -DLOCKSTONE_UNITY_BUILD=ON -DLOCKSTONE_BUILD_TESTS=OFF -DLOCKSTONE_BUILD_BENCH=OFF \
    -DLOCKSTONE_WITH_ASSET_IMPORT=OFF -DLOCKSTONE_WITH_ENET=OFF -DLOCKSTONE_WITH_SODIUM=OFF \
    -DLOCKSTONE_WITH_C_LIBRARY=OFF -DLOCKSTONE_INSTALL=ON \
    -DCMAKE_INSTALL_PREFIX="$folder/prefix" >/dev/null
  cmake --build "$folder/lockstone" --parallel "$jobs" --target lockstone_tool
  cmake --install "$folder/lockstone" >/dev/null
  cmake -S "$source_dir" -B "$folder/game" -G Ninja "${options[@]}" -DCMAKE_BUILD_TYPE=Release \
    -Dlockstone_DIR="$folder/prefix/lib/cmake/lockstone" >/dev/null
  cmake --build "$folder/game" --parallel "$jobs" --target "$tool"
}

# program_of TARGET
program_of() { find "$out/build/$1/game" -type f -executable -name "$tool" -print -quit; }

# hash_match TARGET
hash_match() {
  local runner=() extra=()
  [[ -z $(emulator_of "$1") ]] || runner=("$(emulator_of "$1")")
  [[ $1 != "$flip" ]] || extra=(--flip-bit-at 100)
  say "hash on $1"
  "${runner[@]}" "$(program_of "$1")" hash --log "$log" --json --name "$1" --force \
    --out "$out/$1.json" --states "$out/$1.states" "${extra[@]}"
}

(require_packages demo cross) || true  # a package that cannot be had costs its target
if [[ " ${targets[*]} " == *" riscv64 "* ]]; then (require_packages cross-riscv64) || true; fi
mkdir -p "$out"
for target in "${targets[@]}"; do
  [[ $target == native || -f tools/cmake/toolchains/$target.cmake ]] || die "unknown target $target"
done
build native >&2
for target in "${targets[@]}"; do
  [[ $target == native ]] || build "$target" >&2
done

native=$(program_of native)
if [[ -z $log ]]; then
  log=$out/match.lks
  "$native" record "$log" --ticks 600 --force >&2
fi
# Cross builds read no compressed chunks.
"$native" cut "$log" "$out/plain.lks" --plain --force >&2
log=$out/plain.lks
files=()
for target in "${targets[@]}"; do
  hash_match "$target" >&2
  files+=("$out/$target.json")
done
"$native" compare-hashes "${files[@]}" | tee "$out/table.txt"
exit "${PIPESTATUS[0]}"
