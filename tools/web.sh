#!/usr/bin/env bash
# Builds the npm package `lockstone` in build/web/package, tests it, measures it.
#
# usage: tools/web.sh [build | test [--quick | --long] | brief | bench | serve [PORT]]
#
#   build     (default) both WebAssembly builds by Emscripten, the TypeScript, and a package to install,
#             build/web/lockstone-VERSION.tgz
#   test      builds, then tests the package in Node and in headless Chromium; --quick plays eight
#             golden scenes, not all; --long plays the match of tabs and native clients for a minute, not
#             ten seconds, with a client under qemu-aarch64. The match needs the native command, with WebSockets, in build/release or build/demo
#   brief     builds one module without vectors, quickly compiled (build/web/brief), and tests it in headless
#             Chromium: golden scenes, a match of a tab and a native client, a flipped state. Without npm
#   bench     builds, then writes docs/benchmarks/web.md: size, load time and ticks beside other
#             engines. Let nothing else run meanwhile
#   serve     builds, then serves the testbed on this machine (default port 8000)
#   --help    print this
#
# Missing Debian packages are installed first (as root or through sudo), packages of the npm registry
# into build/web/node. LOCKSTONE_JOBS bounds the number of parallel compilers.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

out=$root/build/web
node_modules=$out/node

# require_programs: Debian's packages, but not those of programs that are there from elsewhere.
require_programs() {
  require_packages demo web
  { command -v node && command -v npm; } >/dev/null || require_packages web-node
}

# fetch_node: the compiler, the browser's driver and the other engines.
fetch_node() {
  mkdir -p "$node_modules"
  if ! cmp -s tools/web/npm/package.json "$node_modules/package.json"; then
    say "npm install"
    cp tools/web/npm/package.json "$node_modules/package.json"
    npm install --prefix "$node_modules" --no-audit --no-fund --no-package-lock --silent ||
      { rm -f "$node_modules/package.json"; die "npm cannot install the packages of tools/web/npm"; }
  fi
}

# shrink MODULE RESULT: optimises for size once more than Emscripten does, which saves half a percent.
shrink() {
  wasm-opt -Oz --low-memory-unused --zero-filled-memory --mvp-features \
    --enable-exception-handling --enable-simd "$1" -o "$2"
}

# build_module PRESET FOLDER SUFFIX: compiles, and puts the modules into the package.
build_module() {
  build_preset "$1"
  shrink "$out/$2/tools/web/lockstone_web.wasm" "$package/dist/lockstone$3.wasm"
  shrink "$out/$2/tools/web/lockstone_web_full.wasm" "$package/dist/lockstone-full$3.wasm"
  shrink "$out/$2/tools/web/lockstone_web_session.wasm" "$package/dist/lockstone-session$3.wasm"
}

package=$out/package
build() {
  require_programs
  fetch_node
  # Where Debian keeps the modules that Emscripten's linker needs: a Node from elsewhere looks not there.
  export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs
  rm -rf "$package"
  mkdir -p "$package/dist"
  build_module web simd -simd
  build_module web-plain plain ""
  say "compile the TypeScript"
  # Beside the packages, where the compiler finds them.
  rm -rf "$node_modules/src"
  cp -r tools/web/src tools/web/tsconfig.json "$node_modules"
  "$node_modules/node_modules/.bin/tsc" -p "$node_modules" --outDir "$package/dist"
  # The package needs no other: the libraries of the one module that has some go into it.
  "$node_modules/node_modules/.bin/esbuild" "$node_modules/src/crypto.ts" --bundle --format=esm --minify \
    --log-level=warning --allow-overwrite --outfile="$package/dist/crypto.js"
  cp tools/web/package.json tools/web/README.md LICENSE "$package"
  (cd "$package" && npm pack --silent --pack-destination "$out" >/dev/null)
}

# build_emulated: the client of another processor, for the long match.
build_emulated() {
  require_packages cross
  dpkg --print-foreign-architectures | grep -qx arm64 || as_root dpkg --add-architecture arm64
  require_packages web-emulated
  cmake --preset aarch64 -B "$out/aarch64" -DLOCKSTONE_WITH_SODIUM=ON \
    -DSodium_LIBRARY=/usr/lib/aarch64-linux-gnu/libsodium.a >/dev/null
  cmake --build "$out/aarch64" --target lockstone_stdio_client
  export LOCKSTONE_EMULATED="qemu-aarch64 -L /usr/aarch64-linux-gnu $out/aarch64/tools/lockstone_stdio_client"
}

# run_tests [--quick | --long]
run_tests() {
  local scenes=all match=short
  [[ ${1-} != --quick ]] || scenes=some
  [[ ${1-} != --long ]] || { match=long && build_emulated; }
  command -v chromium >/dev/null || require_packages web-browser
  say "test the package"
  LOCKSTONE_WEB_SCENES=$scenes LOCKSTONE_WEB_MATCH=$match node --test tools/web/test/*.test.mjs
}

# brief: for tools/test.sh --browser. Its match is without encryption, whose functions are packages of npm.
brief() {
  require_packages demo web-brief
  command -v chromium >/dev/null || require_packages web-brief-browser
  export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs
  local page=$out/brief/package/dist
  build_preset web-brief
  mkdir -p "$page"
  cp "$out/brief/tools/web/lockstone_web_session.wasm" "$page/lockstone-session.wasm"
  esbuild tools/web/test/brief.ts --bundle --format=esm --log-level=warning --outfile="$page/session.js"
  LOCKSTONE_WEB_PACKAGE=$out/brief/package node --test tools/web/test/brief.mjs
}

command=${1-build}
(($# == 0)) || shift
case $command in
  build) build ;;
  test) build && run_tests "$@" ;;
  brief) brief ;;
  bench) build && node tools/web/bench/compare.mjs --page docs/benchmarks/web.md ;;
  serve) build && node tools/web/test/server.mjs "${1-8000}" ;;
  --help) usage ;;
  *) usage >&2; exit 2 ;;
esac
