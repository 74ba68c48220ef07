#!/usr/bin/env bash
# Builds the lockstone command for several processors, compilers and optimisation levels, runs the
# golden scenes and the golden vectors of the numerics on each (under qemu where it must) and compares
# every hash on the way.
#
# usage: tools/cross.sh [TARGET…]     default: all of them
#
#   gcc-O0 gcc-O2 gcc-O3 clang-O0 clang-O3   this machine; the -O0 builds have the asserts on
#   aarch64 riscv64 armhf s390x              cross compilers and qemu-user
#
# Exits 1 when a hash differs, a run fails, or a target named on the command line cannot be built or
# run here. Without named targets such a target is reported and left out. Missing Debian packages are
# installed first (as root or through sudo). LOCKSTONE_JOBS bounds the number of parallel jobs.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

all=(gcc-O0 gcc-O2 gcc-O3 clang-O0 clang-O3 aarch64 riscv64 armhf s390x)

# compiler_of TARGET
compiler_of() {
  case $1 in
    gcc-*) echo g++ ;;
    clang-*) echo clang++ ;;
    armhf) echo arm-linux-gnueabihf-g++ ;;
    *) echo "$1-linux-gnu-g++" ;;
  esac
}

# emulator_of TARGET: the qemu binary, or nothing for this machine.
emulator_of() {
  case $1 in
    gcc-* | clang-*) ;;
    armhf) echo qemu-arm ;;
    *) echo "qemu-$1" ;;
  esac
}

# lacking TARGET: the programs it needs that this machine does not have.
lacking() {
  local program
  for program in "$(compiler_of "$1")" "$(emulator_of "$1")"; do
    [[ -z $program ]] || command -v "$program" >/dev/null || echo "$program"
  done
}

# build TARGET: quiet; its output is kept in a log, which is named when it fails.
build() {
  local log=build/cross/$1.log
  mkdir -p build/cross
  cmake --preset "$1" >"$log" 2>&1 && cmake --build --preset "$1" --parallel "$jobs" >>"$log" 2>&1
}

left_out=0
leave_out() {
  echo "$1 left out: $2"
  left_out=$((left_out + 1))
}

case ${1-} in
  --help) usage; exit ;;
  -*) usage >&2; exit 2 ;;
esac
for target in "$@"; do
  [[ " ${all[*]} " == *" $target "* ]] || die "unknown target $target; there are: ${all[*]}"
done
wanted=("$@")
((${#wanted[@]})) || wanted=("${all[@]}")

# A package that cannot be installed costs its target, not the others.
(require_packages build cross) || true
runners=()
for target in "${wanted[@]}"; do
  mapfile -t programs < <(lacking "$target")
  if ((${#programs[@]})); then
    leave_out "$target" "no ${programs[*]}"
  elif say "build $target" && build "$target"; then
    runners+=("$target=$(emulator_of "$target") $root/build/cross/$target/tools/lockstone")
  else
    grep -m 5 -iE 'error|not found' "build/cross/$target.log" || tail -n 5 "build/cross/$target.log"
    leave_out "$target" "does not build, see build/cross/$target.log"
  fi
done

((${#runners[@]})) || die "no target left"
status=0
python3 -B tools/cross_table.py --jobs "$jobs" "${runners[@]}" || status=1
if (($# && left_out)); then status=1; fi
exit "$status"
