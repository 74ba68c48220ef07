# Shared by the scripts of tools/. To be sourced; sets `root` and goes there.
# shellcheck shell=bash
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# LOCKSTONE_JOBS bounds how many processes run at the same time: compilers, tests, emulators.
jobs=${LOCKSTONE_JOBS:-$(nproc)}

say() { printf '\n== %s\n' "$*" >&2; }

die() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# usage: prints the comment at the head of the calling script.
usage() { sed -n '2,/^$/{s/^# \{0,1\}//p}' "$0"; }

# packages_of SECTION…: the packages that tools/packages.txt lists there.
packages_of() {
  local section
  for section in "$@"; do
    awk -v wanted="[$section]" '/^\[/ {on = $0 == wanted; next} on && NF && !/^#/' tools/packages.txt
  done
}

# missing_of PACKAGE…: those that dpkg does not know as installed, for this machine's architecture or the
# one that is named. Others may be installed beside it.
missing_of() {
  local package architecture native
  native=$(dpkg --print-architecture)
  for package in "$@"; do
    architecture=$native
    [[ $package != *:* ]] || architecture=${package#*:}
    dpkg-query -W -f='${db:Status-Status} ${Architecture}\n' "$package" 2>/dev/null |
      grep -qE "^installed ($architecture|all)$" || echo "$package"
  done
}

as_root() {
  if ((EUID == 0)); then
    env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

apt_install() {
  as_root apt-get install -y -q --no-install-recommends -o DPkg::Lock::Timeout=300 "$@"
}

# impossible PACKAGE…: those that apt cannot even plan to install.
impossible() {
  local package
  for package in "$@"; do
    apt-get install -s "$package" >/dev/null 2>&1 || echo "$package"
  done
}

# install_possible PACKAGE…: as many as can be had. One unknown name makes apt refuse the whole list.
install_possible() {
  local bad possible=() package
  apt_install "$@" && return
  bad=" $(impossible "$@" | tr '\n' ' ')"
  for package in "$@"; do
    [[ $bad == *" $package "* ]] || possible+=("$package")
  done
  ((${#possible[@]} == $# || ${#possible[@]} == 0)) || apt_install "${possible[@]}" || true
}

# require_packages SECTION…: installs missing packages. apt is not touched when none is.
require_packages() {
  local wanted missing log
  command -v dpkg-query >/dev/null || die "needs Debian's apt; elsewhere, install the packages of tools/packages.txt by hand"
  mapfile -t wanted < <(packages_of "$@")
  mapfile -t missing < <(missing_of "${wanted[@]}")
  ((${#missing[@]})) || return 0
  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    die "not root and no sudo; missing packages: ${missing[*]}"
  fi
  say "installing ${missing[*]}"
  log=$(mktemp)
  # A failed update is not final: the lists at hand may do.
  as_root apt-get update -q >"$log" 2>&1 || true
  install_possible "${missing[@]}" >>"$log" 2>&1
  mapfile -t missing < <(missing_of "${missing[@]}")
  ((${#missing[@]} == 0)) || die "cannot install: ${missing[*]} (apt's output: $log)"
  rm -f "$log"
}

# The targets that build_preset builds; none: everything.
build_targets=()

# build_preset PRESET [CMAKE-OPTION…]: configures and builds a preset.
build_preset() {
  local preset=$1
  shift
  say "build $preset"
  cmake --preset "$preset" "$@" >/dev/null  # errors and warnings go to stderr
  cmake --build --preset "$preset" --parallel "$jobs" \
    ${build_targets[@]+--target "${build_targets[@]}"}
}
