import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { test } from "node:test";

import { chromium, withPage } from "./browser.mjs";
import { golden, root } from "./support.mjs";

const skip = chromium ? false : "Chromium is not installed";

test("the testbed plays, pauses, steps and goes back through the history", { skip }, async () => {
  await withPage("/testbed/index.html#wall", async (page) => {
    const state = async () => {
      const text = await page.textContent("#state");
      const [, tick, hash] = /tick (\d+) {2}hash ([0-9a-f]{16})/.exec(text) ?? [];
      return { tick: Number(tick), hash };
    };
    const until = (tick) => page.waitForFunction(
      (least) => Number(/tick (\d+)/.exec(document.getElementById("state").textContent)?.[1]) >= least, tick);
    const click = async (id) => {
      await page.click(`#${id}`);
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    };
    const seek = (tick) => page.evaluate((wanted) => {
      const slider = document.getElementById("tick");
      slider.value = wanted;
      slider.dispatchEvent(new Event("input"));
      return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    }, tick);
    await until(40);
    await click("play");
    const paused = await state();
    await click("step");
    const next = await state();
    assert.equal(next.tick, paused.tick + 1);
    await click("back");
    assert.deepEqual(await state(), paused);
    await click("step");
    assert.deepEqual(await state(), next);
    await seek(20);
    assert.deepEqual(await state(), { tick: 20, hash: golden.wall.chain[1] });
    await click("play");
    await until(60);
    await click("play");
    await seek(30);
    assert.deepEqual(await state(), { tick: 30, hash: golden.wall.chain[2] });
    mkdirSync(`${root}/build/web/shots`, { recursive: true });
    await page.screenshot({ path: `${root}/build/web/shots/testbed.png` });
  });
});
