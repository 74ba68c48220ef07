// Browser tabs and native clients in one match. LOCKSTONE_WEB_MATCH=long plays a minute, not ten seconds. All clients share
// the machine with the browser, so that a tab may be late for a tick, but never wrong.
import assert from "node:assert/strict";
import { test } from "node:test";

import { chromium, withPages } from "./browser.mjs";
import { StdioClient, hostsBrowsers, withMatch } from "./processes.mjs";

const long = process.env.LOCKSTONE_WEB_MATCH === "long";
const ticks = long ? 3600 : 600;
const emulated = Boolean(process.env.LOCKSTONE_EMULATED);
const skip = !chromium ? "Chromium is not installed" : hostsBrowsers() ? false : "no native command with --ws";

// A tab of a busy machine may be silent for long, and is not to be dropped for it; nor is the server by the tab.
const patience = ["--drop-after", "60"];
const address = (match, slot, more = "") => `/test/match.html?url=${encodeURIComponent(match.url)}&seed=1&name=tab` +
  `&token=${encodeURIComponent(match.backend.tokenText(slot))}${more}`;
const reached = (page, tick) => page.waitForFunction((least) => window.played?.ticks >= least, tick, { timeout: long ? 120_000 : 30_000 });
const over = (page) => page.waitForFunction(() => window.played?.over, null, { timeout: 120_000 });
const playedBy = (page) => page.evaluate(() => window.played);

/** Native clients behind a relay that loses 5 % of all datagrams in runs of four. */
async function nativeClients(match, slots) {
  const relay = match.run("lossy", "--to", `${match.port}`, "--loss", "5", "--burst", "4", "--delay", "10", "--jitter", "5");
  const port = (await relay.says(/listening on \S+:(\d+)/))[1];
  return slots.map((slot) => match.run("join", "--token", match.backend.token(slot), "--server", `127.0.0.1:${port}`,
    "--json", "--quiet", ...(slot % 2 === 1 ? ["--predict", "6"] : [])));
}

test(`two tabs and three ${emulated ? "native clients, one of them emulated," : "native clients"} play one match, and a reloaded tab comes back`, { skip }, async () => {
  await withMatch(["--players", "5", "--ticks", `${ticks}`, "--input-delay", "6", "--bodies", "40", ...patience], (match) => withPages(2, async (pages) => {
    await Promise.all(pages.map((page, slot) => page.goto(page.origin + address(match, slot, `&predict=${6 * slot}`))));
    const clients = await nativeClients(match, emulated ? [2, 3] : [2, 3, 4]);
    if (emulated) clients.push(match.keep(new StdioClient(match.url, match.backend.tokenText(4))));
    await reached(pages[1], ticks / 4);
    await pages[1].reload();
    await Promise.all(pages.map(over));
    await match.server.ended;
    await Promise.all(clients.map((client) => client.ended));

    const final = /final hash ([0-9a-f]{16})/.exec(match.server.text)[1];
    for (const client of clients) {
      const { final_hash, ticks: stepped } = JSON.parse(client.text.slice(client.text.indexOf("{")));
      assert.deepEqual([final_hash, stepped], [final, ticks]);
    }
    const tabs = await Promise.all(pages.map(playedBy));
    console.log(JSON.stringify(tabs.map((tab) => tab.stats)));
    for (const tab of tabs) assert.deepEqual([tab.hashes[ticks - 1], tab.ticks, tab.finish], [final, ticks, "completed"]);
    // The reloaded tab steps the ticks that it missed, or begins with a state if they are many.
    const common = Object.keys(tabs[1].hashes);
    assert.equal(match.server.text.match(/player 1 joined/g).length, 2);
    assert.ok(common.length > ticks / 3);
    assert.deepEqual(tabs[1].hashes, Object.fromEntries(common.map((tick) => [tick, tabs[0].hashes[tick]])));
    assert.doesNotMatch(match.server.text, /desync/);
    console.log(match.server.text.trim());
  }));
});

test("a tab whose state is flipped is found and named", { skip }, async () => {
  await withMatch(["--players", "2", "--ticks", "300", "--on-desync", "kick", ...patience], (match) => withPages(1, async ([page]) => {
    await page.goto(page.origin + address(match, 0));
    const [client] = await nativeClients(match, [1]);
    await reached(page, 60);
    const tick = await page.evaluate(() => (window.client.flipForTests(), window.client.ticks));
    await Promise.all([client.ended, match.server.ended, over(page)]);
    assert.match(match.server.text, new RegExp(`desync: tick ${tick}, player 0 "tab", body \\d+ .*position\\.x`));
    assert.match((await playedBy(page)).desync, /position\.x/);
    assert.equal(JSON.parse(client.text.slice(client.text.indexOf("{"))).ticks, 300);
  }));
});
