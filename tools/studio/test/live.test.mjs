import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { execFileSync, spawnSync } from "node:child_process";
import { join } from "node:path";
import { after, test } from "node:test";

import { hostsBrowsers, withMatch } from "../../web/test/processes.mjs";
import { cleanUp, command, person, scratch, skip as noStudio, withPage, withStudio } from "./support.mjs";

after(cleanUp);

const TICKS = 1800;
const skip = noStudio || (hostsBrowsers() ? false : "no native command with --ws");
const MATCH = ["--players", "3", "--start-players", "2", "--spectators", "2", "--input-delay", "6", "--bodies", "30"];

/** A match with two bots, and the page at it. `ticks` 0: until the server is interrupted. */
function live(ticks, options, use) {
  return withMatch([...MATCH, "--ticks", `${ticks}`], async (match) => {
    const bots = [0, 1].map((slot) => match.run("join", "--token", match.backend.token(slot), "--server", `127.0.0.1:${match.port}`,
      "--name", `bot ${slot}`, "--quiet"));
    await withStudio(["--live", match.url, ...options(match)], (address) => withPage(address, (page) => use(page, match)));
    await Promise.all(bots.map((bot) => bot.ended));
  });
}

const finished = (page) => page.waitForFunction(() => /^finished/.test(document.getElementById("live-state")?.textContent), null, { timeout: 60_000 });
// Pixels of a chart's curve in its upper half, in how many columns: none where all values are alike.
const columnsAbove = (page, chart) => page.evaluate((id) => {
  const canvas = document.getElementById(id).closest("figure").querySelector("canvas");
  const { width, height } = canvas;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, Math.floor(height / 2));
  const columns = new Set();
  for (let i = 3; i < data.length; i += 4) if (data[i] > 0) columns.add(((i - 3) / 4) % width);
  return columns.size;
}, chart);
const finalHash = async ({ server }) => (await server.says(/final hash ([0-9a-f]{16})/))[1];

test("a spectator sees the match, and ends with its hash", { skip }, () => live(TICKS, (match) => ["--token", match.backend.token("spectator")], async (page, match) => {
  const { frames, state } = person(page);
  await page.waitForSelector("#live-state");
  await frames();
  assert.equal(await page.textContent("#live-seat"), "spectator");
  assert.equal(await page.textContent("#live-players"), "0 bot 0, 1 bot 1");
  assert.equal(await page.getAttribute("#live-watch", "aria-pressed"), "true");
  assert.equal(await page.isVisible("#transport"), false);
  const early = await state();
  await page.waitForFunction((least) => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > least, early.tick + 60);
  assert.ok(Number.parseFloat(await page.textContent("#chart-received")) > 0.1);
  assert.ok(Number.parseFloat(await page.textContent("#live-jitter-buffer")) > 0, "ticks never come evenly");
  await finished(page);
  await frames();
  assert.deepEqual(await state(), { tick: TICKS, hash: await finalHash(match) });
  assert.match(await page.textContent("#live-events"), /the match is over/);
}));

test("a person plays, says something, and saves a log that proves the match", { skip }, () => live(0, (match) => ["--play", "--name", "person", "--token", match.backend.token(2)], async (page, match) => {
  await page.waitForFunction(() => document.getElementById("live-seat")?.textContent === "player 2");
  await page.waitForFunction(() => document.getElementById("live-players").textContent.includes("2 person"));
  // Walks: the page's own keys stay away.
  await page.focus("#picture");
  await page.waitForFunction(() => / m$/.test(document.getElementById("live-place").textContent));
  const before = (await page.textContent("#live-place")).split(", ").map(Number.parseFloat);
  await page.keyboard.down("ArrowRight");
  await page.waitForFunction(([x, z]) => {
    const [nowX, nowZ] = document.getElementById("live-place").textContent.split(", ").map(Number.parseFloat);
    return Math.hypot(nowX - x, nowZ - z) > 0.5;
  }, before);
  await page.keyboard.up("ArrowRight");
  await page.fill("#live-say", "hello there");
  await page.press("#live-say", "Enter");
  await page.waitForFunction(() => document.getElementById("live-events").textContent.includes("person: hello there"));
  // A bot goes on in the person's place, until the page has guessed wrong and stepped ticks again.
  await page.check("#live-bot");
  await page.waitForFunction(() => /^[1-9]\d* computed, [1-9]/.test(document.getElementById("live-islands-again").textContent));
  match.server.process.kill("SIGINT");
  await finished(page);
  const hash = await finalHash(match);
  // Wrong guesses about the bots: of each tick that was stepped again, some islands were computed and others remembered.
  const again = await page.textContent("#live-islands-again");
  const [computed, remembered] = /^(\d+) computed, (\d+) remembered$/.exec(again).slice(1).map(Number);
  assert.ok(computed > 0 && remembered > 0, again);
  for (const chart of ["chart-again", "chart-computed", "chart-recalled"]) assert.ok(await columnsAbove(page, chart) > 3, chart);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#live-save")]);
  const log = join(scratch, "live.lks");
  await download.saveAs(log);
  assert.ok(readFileSync(log).length > 1000);
  const [verdict] = JSON.parse(execFileSync(command, ["verify", "--json", log], { encoding: "utf8" }));
  assert.deepEqual([verdict.outcome, verdict.complete, verdict.final_hash], ["same", true, hash]);
  assert.doesNotMatch(match.server.text, /desync/);
}));

test("an address that is none reaches no header", { skip }, () => {
  const { status, stderr } = spawnSync(command, ["studio", "--live", "ws://a; script-src *"], { encoding: "utf8" });
  assert.equal(status, 64);
  assert.match(stderr, /no address like/);
});

test("a match that is not there is named", { skip }, () => withStudio(["--live", "ws://127.0.0.1:9/"], async (address) => {
  await assert.rejects(withPage(address, async (page) => {
    await page.waitForFunction(() => document.getElementById("message").textContent.includes("127.0.0.1:9"), null, { timeout: 20_000 });
  }), /ERR_UNSAFE_PORT|ERR_CONNECTION_REFUSED|WebSocket/); // the browser itself writes the error to its console
}));
