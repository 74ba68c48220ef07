import assert from "node:assert/strict";
import { test } from "node:test";

import { chromium, withPage } from "./browser.mjs";
import { someOf } from "./golden.mjs";
import { golden } from "./support.mjs";

const skip = chromium ? false : "Chromium is not installed";
const scenes = process.env.LOCKSTONE_WEB_SCENES === "some" ? someOf(golden) : golden;

for (const simd of [true, false]) {
  test(`golden scenes have the native hashes in Chromium ${simd ? "with" : "without"} vectors`, { skip }, async () => {
    const differing = await withPage("/test/empty.html", (page) => page.evaluate(async ({ simd, scenes }) => {
      const full = await import("/lockstone/dist/full.js");
      const { differingScenes } = await import("/test/golden.mjs");
      return differingScenes(full, await full.loadFull({ simd }), scenes);
    }, { simd, scenes }));
    assert.deepEqual(differing, []);
  });
}

test("the core plays in Chromium and chooses vectors by itself", { skip }, async () => {
  const played = await withPage("/test/empty.html", (page) => page.evaluate(async () => {
    const { Motion, World, halfSpace, load, sphere } = await import("/lockstone/dist/index.js");
    const lockstone = await load();
    const world = new World(lockstone, { bodyCapacity: 64 });
    world.createBody({ shape: halfSpace(), motion: Motion.static });
    world.createBody({ shape: sphere("0.25"), position: [0, 10, 0] });
    world.step(120);
    return { simd: lockstone.simd, hash: world.hash };
  }));
  assert.deepEqual(played, { simd: true, hash: "5bc0d10ce0d2c91d" });
});
