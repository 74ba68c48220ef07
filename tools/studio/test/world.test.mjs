// A game that shows its world (tools/examples/watched), and the page at it.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { after, test } from "node:test";

import { cleanUp, command, person, skip as noStudio, withPage, withStudio } from "./support.mjs";

after(cleanUp);

const game = join(dirname(command), "lockstone_watched");
const skip = noStudio || (existsSync(game) ? false : "lockstone_watched is not built");

/** Runs `use(address, hashes)` while the game plays; `hashes` by tick, as far as it has played. */
async function withGame(ticks, use) {
  const program = spawn(game, [`${ticks}`], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const hashes = new Map(), lines = createInterface({ input: program.stdout });
    const address = await new Promise((done) => {
      lines.on("line", (line) => {
        const [first, tick, hash] = line.split(" ");
        if (first === "tick") hashes.set(Number(tick), hash);
        else done(line);
      });
    });
    return await use(address, hashes, program);
  } finally {
    program.kill();
  }
}

test("the page shows the world of a game, with its hashes, until it ends", { skip }, () => withGame(1800, (address, hashes, program) =>
  withStudio(["--world", address], (page) => withPage(page, async (page) => {
    const { frames, press, pixels } = person(page);
    // Both in one look: the world moves on.
    const state = () => page.evaluate(() => ({ tick: Number(document.getElementById("tick-text").textContent.split(" ")[1]), hash: document.getElementById("hash-text").textContent }));
    await page.waitForSelector("#world-state");
    await frames();
    assert.equal(await page.getAttribute("#view-world", "aria-current"), "page");
    assert.equal(await page.isVisible("#transport"), false);
    const early = await state();
    assert.equal(await page.textContent("#world-state"), "runs");
    assert.equal(await page.textContent("#count-bodies"), "41");
    await page.waitForFunction((least) => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > least, early.tick + 120);
    const late = await state();
    assert.equal(early.hash, hashes.get(early.tick));
    assert.equal(late.hash, hashes.get(late.tick));
    assert.ok(Number(await page.textContent("#world-states-received")) > 20);
    assert.ok(Number(await page.textContent("#count-points")) > 10);
    const before = await pixels(255, 59, 107);
    await page.check("#show-contacts");
    await frames();
    assert.ok((await pixels(255, 59, 107)) > before + 10, "contacts are drawn");
    await press("p"); // the page's keys work
    if (process.env.LOCKSTONE_SHOTS) await page.screenshot({ path: join(process.env.LOCKSTONE_SHOTS, "world.png") });
    program.kill();
    await page.waitForFunction(() => document.getElementById("world-state").textContent === "ended");
  }))));

test("a wrong token shows nothing", { skip }, () => withGame(1800, (address) =>
  withStudio(["--world", address.replace(/[^/]+$/, "0".repeat(32))], (page) => withPage(page, async (page) => {
    await page.waitForFunction(() => document.getElementById("message").textContent.includes("no game shows its world there"));
  }))));

test("an address without a token is refused", { skip: noStudio }, () => {
  for (const address of ["ws://127.0.0.1:9000/", "ws://127.0.0.1:9000", "nonsense", "ws://a; script-src */0a"]) {
    const { status, stderr } = spawnSync(command, ["studio", "--world", address], { encoding: "utf8" });
    assert.equal(status, 64, address);
    assert.match(stderr, /no address like/);
  }
});
