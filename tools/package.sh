#!/usr/bin/env bash
# Builds the Debian packages and their list of contents (SBOM) in build/package.
#
# usage: tools/package.sh [--check] [--chroot]
#
#   --check    also build them in another folder and compare the bytes, run lintian, and build and run a
#              program against the unpacked packages
#   --chroot   also install them in a bare Debian of debootstrap and run the command and a program there
#              (root; downloads about 100 MB)
#   --help     print this
#
# The date of everything in the packages is that of the last commit, or SOURCE_DATE_EPOCH.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# make_packages SOURCE: builds them in SOURCE/build/package.
make_packages() {
  local folder=$1/build/package
  say "build $folder"
  (cd "$1" && cmake --preset package >/dev/null)
  cmake --build "$folder" --parallel "$jobs" >/dev/null
  rm -f "$folder"/*.deb
  (cd "$folder" && umask 022 && cpack >/dev/null)
  pack_again "$folder"/*.deb
  python3 -B "$1/tools/packaging/sbom.py" "$folder" >"$folder/lockstone.spdx.json"
}

# pack_again DEB…: dpkg-deb orders the files, and CPack's calls of ldconfig give way to the package's trigger.
pack_again() {
  local deb folder
  for deb in "$@"; do
    folder=$(mktemp -d)
    dpkg-deb -R "$deb" "$folder"
    rm -f "$folder"/DEBIAN/post{inst,rm}
    chmod 755 "$folder"
    find "$folder" -exec touch -hd "@$SOURCE_DATE_EPOCH" {} +
    dpkg-deb --root-owner-group -Zxz -b "$folder" "$deb" >/dev/null
    rm -rf "$folder"
  done
}

sums() { (cd "$1/build/package" && sha256sum ./*.deb lockstone.spdx.json); }

# compare_with_another: the tracked and new files, copied and built under another name.
compare_with_another() {
  local other
  other=$(mktemp -d)
  git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$other"
  CCACHE_DISABLE=1 make_packages "$other"
  diff <(sums "$root") <(sums "$other") || die "two builds differ"
  say "two builds are equal"
  rm -rf "$other"
}

# run_unpacked: a program built against the packages, without installing them.
run_unpacked() {
  local folder lib
  folder=$(mktemp -d)
  for deb in build/package/*.deb; do dpkg-deb -x "$deb" "$folder"; done
  lib=$(dirname "$(find "$folder" -name 'liblockstone_c.so')")
  python3 -B tests/bindings/page_code.py docs/how-to/bindings.md c "$folder/program.c"
  cc -std=c11 -Wall -Werror "$folder/program.c" -o "$folder/program" -I "$folder/usr/include" -L "$lib" -llockstone_c
  LD_LIBRARY_PATH=$lib "$folder/program"
  "$folder/usr/bin/lockstone" --version
  rm -rf "$folder"
}

run_in_chroot() {
  local bare
  bare=$(mktemp -d)
  as_root debootstrap --variant=minbase --include=gcc,libc6-dev,pkg-config bookworm "$bare" >/dev/null
  as_root cp build/package/*.deb "$bare/tmp"
  python3 -B tests/bindings/page_code.py docs/how-to/bindings.md c /dev/stdout | as_root tee "$bare/tmp/program.c" >/dev/null
  # shellcheck disable=SC2016
  as_root chroot "$bare" sh -ec '
    apt-get install -y -q --no-install-recommends /tmp/*.deb >/dev/null
    cd /tmp
    cc -std=c11 program.c -o program $(pkg-config --cflags --libs lockstone_c)
    ./program
    lockstone record match.lks --ticks 60 >/dev/null
    lockstone verify --strict match.lks'
  as_root rm -rf "$bare"
}

check=false chroot=false
for argument in "$@"; do
  case $argument in
    --check) check=true ;;
    --chroot) chroot=true ;;
    --help) usage; exit ;;
    *) usage >&2; exit 2 ;;
  esac
done

export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
require_packages demo build package
make_packages "$root"
if "$check"; then
  lintian --allow-root --fail-on error,warning --suppress-tags-from-file tools/packaging/lintian-suppressed build/package/*.deb
  say "lintian is content"
  run_unpacked
  compare_with_another
fi
if "$chroot"; then run_in_chroot; fi
sums "$root"
