#!/usr/bin/env bash
# Builds the command as the demo needs it, in build/demo, and runs `lockstone demo`: a server and four
# clients on this machine.
#
# usage: tools/demo.sh [OPTION…]      options go to the command; --help lists them
#
# Replaces demo.lks and demo.svg of the run before.
#
# Missing Debian packages are installed first (as root or through sudo).

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

require_packages demo
build_preset demo
# Paths among the options are the caller's.
cd "$OLDPWD"
# exec: Ctrl-C and the exit status belong to the command.
exec "$root"/build/demo/tools/lockstone demo --force "$@"
