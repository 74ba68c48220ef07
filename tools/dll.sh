#!/usr/bin/env bash
# Builds the C library as a DLL for Windows by MinGW, and a program of C against it; plays the golden
# scenes through it under Wine and compares every hash.
#
# usage: tools/dll.sh
#
# The DLL and its import library stay in build/cross/windows-dll. Missing Debian packages are installed
# first (as root or through sudo). LOCKSTONE_JOBS bounds the number of parallel jobs.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

case ${1-} in
  --help) usage; exit ;;
  ?*) usage >&2; exit 2 ;;
esac
require_packages demo build cross-more
build_preset windows-dll
folder=build/cross/windows-dll/tools/bindings/c
x86_64-w64-mingw32-gcc -std=c11 -Wall -Wextra -Werror -O1 -I tools/bindings/c tests/bindings/c/golden_scenes.c \
  "$folder"/liblockstone_c-*.dll.a -o "$folder/golden_scenes.exe"
say "play the golden scenes"
WINEDEBUG=${WINEDEBUG:--all} python3 -B tests/bindings/golden_scenes.py wine "$folder/golden_scenes.exe"
