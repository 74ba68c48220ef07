#!/usr/bin/env bash
# Builds the lockstone command for several processors, compilers and optimisation levels, runs the
# golden scenes and the golden vectors of the numerics on each (under qemu where it must) and compares
# every hash on the way.
#
# usage: tools/cross.sh [TARGET…]     default: all of them
#
#   gcc-O0 gcc-O2 gcc-Os gcc-O3 clang-O0 clang-O3   this machine; the -O0 builds have the asserts on
#   iso                                      this machine, ISO C++: no 128-bit type, no extension
#   sanitized                                this machine, AddressSanitizer and UBSan
#   simd-scalar simd-sse4 simd-avx2 simd-avx512   gcc-O3 with one kind of vectors
#   aarch64 riscv64 armhf s390x              cross compilers and qemu-user; aarch64 with its vectors
#   i386                                     32-bit x86
#   windows                                  MinGW, under Wine
#   wasm                                     WebAssembly with its vectors, under Node
#   aarch64-scalar wasm-scalar               the same two programs without vectors
#
# A match of bots in the arena is recorded on the first target and verified on every one. The table
# also goes to build/cross/table.txt and, as JUnit XML, to build/cross/junit.xml.
#
# Exits 1 when a hash differs, a run fails, or a target named on the command line cannot be built or
# run here. Without named targets such a target is reported and left out. Missing Debian packages are
# installed first (as root or through sudo). LOCKSTONE_JOBS bounds the number of parallel jobs.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

all=(gcc-O0 gcc-O2 gcc-Os gcc-O3 clang-O0 clang-O3 iso sanitized simd-scalar simd-sse4 simd-avx2 simd-avx512
  aarch64 aarch64-scalar riscv64 armhf s390x i386 windows wasm wasm-scalar)

# compiler_of TARGET
compiler_of() {
  case $(preset_of "$1") in
    gcc-* | iso | sanitized) echo g++ ;;
    clang-*) echo clang++ ;;
    i386) echo i686-linux-gnu-g++ ;;
    windows) echo x86_64-w64-mingw32-g++-posix ;;
    wasm) echo em++ ;;
    armhf) echo arm-linux-gnueabihf-g++ ;;
    *) echo "$(preset_of "$1")-linux-gnu-g++" ;;
  esac
}

# emulator_of TARGET: the qemu binary, or nothing for this machine.
emulator_of() {
  case $(preset_of "$1") in
    gcc-* | clang-* | iso | sanitized | i386) ;;
    windows) echo wine ;;
    wasm) echo node ;;
    armhf) echo qemu-arm ;;
    *) echo "qemu-$(preset_of "$1")" ;;
  esac
}

# lacking TARGET: the programs it needs that this machine does not have.
lacking() {
  local program
  for program in "$(compiler_of "$1")" "$(emulator_of "$1")"; do
    [[ -z $program ]] || command -v "$program" >/dev/null || echo "$program"
  done
}

# preset_of TARGET: the preset that builds it.
preset_of() {
  case $1 in
    simd-*) echo gcc-O3 ;;
    *) echo "${1%-scalar}" ;;
  esac
}

# vectors_of TARGET: the kind that it is told to use, or nothing for the best there is.
vectors_of() {
  case $1 in
    simd-*) echo "${1#simd-}" ;;
    *-scalar) echo scalar ;;
  esac
}

# program_of TARGET
program_of() {
  local program=$root/build/cross/$(preset_of "$1")/tools/lockstone
  case $1 in
    windows) echo "$program.exe" ;;
    *) echo "$program" ;;
  esac
}

# runs_here TARGET: whether this processor has the vectors.
runs_here() {
  [[ $1 != simd-* ]] ||
    "$(program_of "$1")" run --scene spin --ticks 1 --simd "$(vectors_of "$1")" >/dev/null 2>&1
}

# runner_of TARGET: the command line, for cross_table.py.
runner_of() {
  local runner vectors
  runner="$1=$(emulator_of "$1") $(program_of "$1")"
  vectors=$(vectors_of "$1")
  if [[ -n $vectors ]]; then runner+=" :: --simd $vectors"; fi
  echo "$runner"
}

# log_of TARGET: the output of its build.
log_of() { echo "build/cross/$(preset_of "$1").log"; }

# mark_of TARGET: a file that is there when it is built.
mark_of() { echo "build/cross/$(preset_of "$1").built"; }

# build TARGET JOBS: quiet; its output is kept in a log, which is named when it fails.
build() {
  local log preset
  log=$(log_of "$1") preset=$(preset_of "$1")
  cmake --preset "$preset" >"$log" 2>&1 &&
    cmake --build --preset "$preset" --parallel "$2" >>"$log" 2>&1 && touch "$(mark_of "$1")"
}

# build_all: as many of the wanted presets at the same time as there are jobs. Where each has one job, no
# processor is idle while the other one compiles the last, longest file.
build_all() {
  local -A targets=()
  local target
  mkdir -p build/cross
  for target in "${wanted[@]}"; do
    rm -f "$(mark_of "$target")"
    if [[ -z $(lacking "$target") ]]; then targets[$(preset_of "$target")]=$target; fi
  done
  for target in "${targets[@]}"; do
    while (($(jobs -rp | wc -l) >= jobs)); do wait -n || true; done
    say "build $(preset_of "$target")"
    build "$target" $(((jobs + ${#targets[@]} - 1) / ${#targets[@]})) &
  done
  wait
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
(require_packages demo build clang cross) || true
if [[ " ${wanted[*]} " == *" riscv64 "* ]]; then (require_packages cross-riscv64) || true; fi
if [[ " ${wanted[*]} " =~ \ (i386|windows|wasm|wasm-scalar)\  ]]; then (require_packages cross-more) || true; fi
export WINEDEBUG=${WINEDEBUG:--all}
# Where Debian keeps the modules that Emscripten's linker needs: a Node from elsewhere looks not there.
export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs
build_all
runners=()
for target in "${wanted[@]}"; do
  mapfile -t programs < <(lacking "$target")
  if ((${#programs[@]})); then
    leave_out "$target" "no ${programs[*]}"
  elif [[ -e $(mark_of "$target") ]]; then
    if runs_here "$target"; then
      runners+=("$(runner_of "$target")")
    else
      leave_out "$target" "this processor cannot run it"
    fi
  else
    grep -m 5 -iE 'error|not found' "$(log_of "$target")" || tail -n 5 "$(log_of "$target")"
    leave_out "$target" "does not build, see $(log_of "$target")"
  fi
done

((${#runners[@]})) || die "no target left"
status=0
python3 -B tools/cross_table.py --jobs "$jobs" --junit build/cross/junit.xml "${runners[@]}" |
  tee build/cross/table.txt || status=1
if (($# && left_out)); then status=1; fi
exit "$status"
