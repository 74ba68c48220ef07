// The package under test, and the files beside it. LOCKSTONE_WEB_PACKAGE names its folder.
import { readFileSync } from "node:fs";
import { fileURLToPath, pathToFileURL } from "node:url";
import { resolve } from "node:path";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
export const folder = resolve(process.env.LOCKSTONE_WEB_PACKAGE ?? `${root}/build/web/package`);
export const full = await import(pathToFileURL(`${folder}/dist/full.js`));
export const golden = JSON.parse(readFileSync(`${root}/tests/golden/scenes.json`, "utf8"));

/** A world with a floor, and a ball 10 m above it. */
export function ballAbove(lockstone, definition = {}) {
  const world = new full.World(lockstone, { bodyCapacity: 64, ...definition });
  world.createBody({ shape: full.halfSpace(), motion: full.Motion.static });
  const ball = world.createBody({ shape: full.sphere("0.25"), position: [0, 10, 0] });
  return { world, ball };
}
