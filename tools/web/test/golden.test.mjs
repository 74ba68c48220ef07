// LOCKSTONE_WEB_SCENES=some plays eight short scenes alone.
import assert from "node:assert/strict";
import { test } from "node:test";

import { differingScenes, someOf } from "./golden.mjs";
import { full, golden } from "./support.mjs";

const scenes = process.env.LOCKSTONE_WEB_SCENES === "some" ? someOf(golden) : golden;

for (const simd of [true, false]) {
  test(`golden scenes have the native hashes ${simd ? "with" : "without"} vectors`, async () => {
    const lockstone = await full.loadFull({ simd });
    assert.equal(lockstone.simd, simd);
    assert.ok(Object.keys(scenes).every((name) => full.sceneNames(lockstone).includes(name)));
    assert.deepEqual(differingScenes(full, lockstone, scenes), []);
  });
}
