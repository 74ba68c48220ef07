// tools/demo.sh --play: its match opens in the user's browser, and a page plays in it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, test } from "node:test";

import { chromium, withPages } from "./browser.mjs";
import { hostsBrowsers } from "./processes.mjs";
import { root } from "./support.mjs";

const skip = !chromium ? "Chromium is not installed" : hostsBrowsers() ? false : "no native command with --ws";
const scratch = mkdtempSync(join(tmpdir(), "lockstone-play-"));
after(() => rmSync(scratch, { recursive: true }));

/** Runs `use(lines)` with the lines that the host prints until the match is open. */
async function withHost(environment, use) {
  const host = spawn(process.execPath, [`${root}/tools/web/play/host.mjs`, "--bots", "2", "--tabs", "1"],
    { stdio: ["ignore", "pipe", "inherit"], env: { ...process.env, ...environment } });
  const ended = new Promise((resolve) => host.on("close", resolve));
  try {
    const lines = [];
    for await (const line of createInterface({ input: host.stdout })) {
      lines.push(line);
      if (line.startsWith("Ctrl-C")) break;
    }
    await use(lines);
  } finally {
    host.kill("SIGINT");
    await ended;
  }
}

test("the host opens a seat where there is a display, and a page plays", { skip }, async () => {
  const opened = join(scratch, "opened");
  writeFileSync(join(scratch, "xdg-open"), `#!/bin/sh\necho "$1" > "${opened}.new" && mv "${opened}.new" "${opened}"\n`, { mode: 0o755 });
  await withHost({ DISPLAY: ":7", WAYLAND_DISPLAY: "", PATH: `${scratch}:${process.env.PATH}` }, (lines) => withPages(1, async ([page]) => {
    const [, address] = /^seat 0: (http:\S+)$/.exec(lines[0]);
    assert.equal(lines[1], "Seat 0 opens in your browser.");
    while (!existsSync(opened)) await new Promise((resolve) => setTimeout(resolve, 20));
    assert.equal(readFileSync(opened, "utf8").trim(), address);
    await page.goto(address);
    await page.waitForFunction(() => window.client?.state === "running" && window.client.ticks > 60);
    // Null while the player is out of the arena.
    await page.evaluate(() => (window.place = () => [...window.client.world.bodies()]
      .find((body) => Number(body.view.userData & 0xffffffn) === 1 + 256 * window.client.slot)?.position ?? null));
    await page.focus("#picture");
    const from = await (await page.waitForFunction(() => window.place())).jsonValue();
    await page.keyboard.down("w");
    await page.waitForFunction(([x, , z]) => window.place() && Math.hypot(window.place()[0] - x, window.place()[2] - z) > 0.2, from);
    await page.keyboard.up("w");
    assert.match(await page.textContent("#players"), /tab 0 · 1 bot 1 · 2 bot 2/);
  }));
});

test("without a display, or without a browser, the host prints the addresses alone", { skip }, async () => {
  await withHost({ DISPLAY: "", WAYLAND_DISPLAY: "", PATH: `${scratch}:${process.env.PATH}` }, (lines) => {
    assert.deepEqual(lines.map((line) => line.split(":")[0]), ["seat 0", "Ctrl-C ends the match."]);
  });
  await withHost({ DISPLAY: ":7", PATH: join(scratch, "nothing") }, (lines) => {
    assert.deepEqual(lines.map((line) => line.split(":")[0]), ["seat 0", "Ctrl-C ends the match."]);
  });
});
