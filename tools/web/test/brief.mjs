// The test of `tools/web.sh brief`: a tab has the native hashes, plays with a native client, and a flipped one is found. It
// needs no package of npm. LOCKSTONE_WEB_PACKAGE names the folder of the page's modules.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { someOf } from "./golden.mjs";
import { withTab } from "./piped_browser.mjs";
import { hostsBrowsers, withMatch } from "./processes.mjs";
import { serve } from "./server.mjs";

const golden = JSON.parse(readFileSync(fileURLToPath(new URL("../../../tests/golden/scenes.json", import.meta.url)), "utf8"));
const TICKS = 300;
const PREDICTED = 6; // ticks

/** A match of two: a tab, which runs `predicted` ticks ahead, has seat 0, a native client seat 1. */
function withTwo(predicted, options, use) {
  const all = ["--insecure", "--players", "2", "--input-delay", "6", "--drop-after", "60", ...options];
  return withTab((tab) => withServer((origin) => withMatch(all, async (match) => {
    await tab.goto(`${origin}/test/match.html?url=${encodeURIComponent(match.url)}&seed=1&name=tab&slot=0&predict=${predicted}`);
    const client = match.run("join", "--insecure", "--server", `127.0.0.1:${match.port}`, "--slot", "1", "--json", "--quiet");
    const played = () => tab.evaluate(() => window.played);
    const reached = (tick) => tab.waitFor((least) => window.played?.ticks >= least, tick);
    const over = async () => {
      await Promise.all([tab.waitFor(() => window.played?.over), client.ended, match.server.ended]);
      return { tab: await played(), client: JSON.parse(client.text.slice(client.text.indexOf("{"))), server: match.server.text };
    };
    return use({ tab, reached, over });
  })));
}

async function withServer(use) {
  const server = await serve();
  try {
    return await use(`http://127.0.0.1:${server.address().port}`);
  } finally {
    server.close();
  }
}

test("golden scenes have the native hashes in a browser", () => withTab((tab) => withServer(async (origin) => {
  await tab.goto(`${origin}/test/empty.html`);
  const differing = await tab.evaluate(async (scenes) => {
    const lockstone = await import("/lockstone/dist/session.js");
    const { differingScenes } = await import("/test/golden.mjs");
    return differingScenes(lockstone, await lockstone.loadSession(), scenes);
  }, someOf(golden));
  assert.deepEqual(differing, []);
})));

test("a tab, reloaded on its way, and a native client play one match", () => {
  assert.ok(hostsBrowsers(), "the native command has no WebSockets");
  return withTwo(PREDICTED, ["--ticks", `${TICKS}`], async ({ tab, reached, over }) => {
    await reached(TICKS / 4);
    await tab.reload();
    const ended = await over();
    const final = /final hash ([0-9a-f]{16})/.exec(ended.server)[1];
    assert.deepEqual([ended.client.ticks, ended.client.final_hash], [TICKS, final]);
    assert.deepEqual([ended.tab.ticks, ended.tab.hashes[TICKS - 1], ended.tab.finish], [TICKS, final, "completed"]);
    assert.equal(ended.server.match(/player 0 joined/g).length, 2);
    assert.doesNotMatch(ended.server, /desync/);
  });
});

test("a tab whose state is flipped is found and named", () => withTwo(0, ["--ticks", "240", "--on-desync", "kick"], async ({ tab, reached, over }) => {
  await reached(60);
  const tick = await tab.evaluate(() => (window.client.flipForTests(), window.client.ticks));
  const ended = await over();
  assert.match(ended.server, new RegExp(`desync: tick ${tick}, player 0 "tab", body \\d+ .*position\\.x`));
  assert.match(ended.tab.desync, /position\.x/);
  assert.equal(ended.client.ticks, 240);
}));
