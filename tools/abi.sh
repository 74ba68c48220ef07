#!/usr/bin/env bash
# Compares the C interface of two trees: fails where a function or a type was removed or changed, and
# shows it. New functions pass. A field appended to a structure that begins with `size` is shown too:
# that change is allowed, any other raises LKS_C_ABI.
#
# usage: tools/abi.sh OLD NEW
#
# OLD and NEW are folders with lockstone.h in them: tools/bindings/c of a checkout, or an installed
# include folder. Each interface is compiled into a library of empty functions, whose types abidiff
# (Debian's abigail-tools) then compares. The status is abidiff's, 1 when it cannot compare.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# stub HEADERS LIBRARY: the interface as a library with debugging information.
stub() {
  [[ -f $1/lockstone.h ]] || die "no lockstone.h in $1"
  { echo '#include "lockstone.h"'
    cat "$1"/lockstone_c/*.h | tr '\n' ' ' |
      grep -oE 'LKS_API [^;(]*\([^;]*\);' |
      sed -E 's/^LKS_API void ([^;]*);/void \1 {}/; t; s/^LKS_API ([^;]*);/\1 { return 0; }/'
  } >"$2.c"
  cc -std=c11 -g -w -shared -fPIC -I "$1" -Wl,-soname,liblockstone_c.so -o "$2" "$2.c"
}

[[ ${1-} != --help ]] || { usage; exit; }
(($# == 2)) || { usage >&2; exit 2; }
cd "$OLDPWD"  # the folders are named from the caller's
command -v abidiff >/dev/null || die "needs abidiff: apt-get install abigail-tools"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
stub "$1" "$folder/old.so"
stub "$2" "$folder/new.so"
status=0
abidiff --no-added-syms "$folder/old.so" "$folder/new.so" || status=$?
exit "$status"
