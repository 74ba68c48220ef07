#!/usr/bin/env bash
# Builds the command as the demo needs it, in build/demo, and runs `lockstone demo`: a server and four
# clients on this machine.
#
# usage: tools/demo.sh [OPTION…]      options go to the command; --help lists them
#
# Replaces demo.lks and demo.svg of the run before.
#
#   --play [--bots N] [--tabs N] [--port PORT] [--no-open]
#             instead: a match of bots (3) with seats for browser tabs (2), played with the keyboard.
#             Prints the pages' addresses and, where there is a display, opens the first one in your
#             browser; Ctrl-C ends it. Builds the npm package if there is none, by tools/web.sh: large
#
# Missing Debian packages are installed first (as root or through sudo).

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

require_packages demo
if [[ ${1-} == --play ]]; then
  shift
  require_packages web-server
  build_preset demo
  [[ -f build/web/package/dist/session.js ]] || tools/web.sh build
  LOCKSTONE_COMMAND=$root/build/demo/tools/lockstone exec node tools/web/play/host.mjs "$@"
fi
build_preset demo
# Paths among the options are the caller's.
cd "$OLDPWD"
# exec: Ctrl-C and the exit status belong to the command.
exec "$root"/build/demo/tools/lockstone demo --force "$@"
