#!/usr/bin/env bash
# Builds the project and runs `lockstone demo`: a server and four clients on this machine.
#
# usage: tools/demo.sh [OPTION…]      options go to the command; --help lists them
#
# Missing Debian packages are installed first (as root or through sudo).

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

require_packages build
build_targets=(lockstone)
build_preset release
# Paths among the options are the caller's.
cd "$OLDPWD"
# exec: Ctrl-C and the exit status belong to the command.
exec "$root"/build/release/tools/lockstone demo "$@"
