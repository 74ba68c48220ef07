#!/usr/bin/env bash
# Builds the page of `lockstone studio` in build/studio/page, and the command with it.
#
# usage: tools/studio.sh [build | page | test | bench]
#
#   build     (default) the page, then build/release/tools/lockstone with the page in it
#   page      the page alone: WebAssembly by Emscripten, TypeScript by npm's packages
#   test      builds, then drives the page in headless Chromium
#   bench     builds, then measures how fast a log of ten minutes opens and is scrubbed, and how many
#             pictures a second show 1,000 bodies
#   --help    print this
#
# Missing Debian packages are installed first (as root or through sudo), packages of the npm registry
# into build/studio/node. LOCKSTONE_JOBS bounds the number of parallel compilers.

# shellcheck source=lib.sh source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

out=$root/build/studio
require_programs() {
  require_packages demo web studio
  { command -v node && command -v npm; } >/dev/null || require_packages web-node
}

# fetch_node: three.js, the bundler, the compiler, the browser's driver.
fetch_node() {
  mkdir -p "$out/node"
  if ! cmp -s tools/studio/package-lock.json "$out/node/package-lock.json" || [[ ! -d $out/node/node_modules ]]; then
    say "npm ci"
    cp tools/studio/package.json tools/studio/package-lock.json "$out/node"
    npm ci --prefix "$out/node" --no-audit --no-fund --silent || die "npm cannot install the packages of tools/studio"
  fi
}

build_page() {
  require_programs
  fetch_node
  # Where Debian keeps the modules that Emscripten's linker needs.
  export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs
  cmake --preset web >/dev/null
  say "build the studio's WebAssembly"
  cmake --build --preset studio --parallel "$jobs"
  say "build the page"
  "$out/node/node_modules/.bin/tsc" -p tools/studio
  node tools/studio/build.mjs "$root/build/web/simd/tools/web/lockstone_studio.wasm" "$out/page"
}

build() {
  build_page
  build_targets=(lockstone lockstone_watched)
  build_preset release
}

command=${1-build}
case $command in
  build) build ;;
  page) build_page ;;
  test)
    build
    command -v chromium >/dev/null || require_packages web-browser
    say "drive the page"
    node --test --test-concurrency=1 tools/studio/test/*.test.mjs
    ;;
  bench) build && node tools/studio/bench/long_log.mjs && node tools/studio/bench/frames.mjs ;;
  --help) usage ;;
  *) usage >&2; exit 2 ;;
esac
