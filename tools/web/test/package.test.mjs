// The package as its users install it. Needs the file that `tools/web.sh` packs.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { gzipSync } from "node:zlib";

import { folder, root } from "./support.mjs";

const version = JSON.parse(readFileSync(`${root}/tools/web/package.json`, "utf8")).version;
const packed = `${root}/build/web/lockstone-${version}.tgz`;
const skip = existsSync(packed) ? false : "tools/web.sh has not packed it";
const scratch = mkdtempSync(join(tmpdir(), "lockstone-web-"));
after(() => rmSync(scratch, { recursive: true }));

/** The first block of JavaScript of a page. */
function programOf(page) {
  return /^```js\n(.*?)^```$/ms.exec(readFileSync(`${root}/${page}`, "utf8"))[1];
}

test("the package installs, and its README's program prints the line that it names", { skip }, () => {
  const readme = readFileSync(`${root}/tools/web/README.md`, "utf8").replace(/\s+/g, " ");
  writeFileSync(`${scratch}/package.json`, JSON.stringify({ private: true, type: "module" }));
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", "--silent", packed], { cwd: scratch });
  writeFileSync(`${scratch}/ball.mjs`, programOf("tools/web/README.md"));
  const printed = execFileSync(process.execPath, ["ball.mjs"], { cwd: scratch, encoding: "utf8" }).trim();
  assert.ok(readme.includes(`It prints \`${printed}\``), printed);
  assert.equal(programOf("docs/how-to/web.md"), programOf("tools/web/README.md"));
});

test("its types refuse wrong programs", { skip }, () => {
  writeFileSync(`${scratch}/types.mts`, `
    import { World, castRay, load, sphere } from "lockstone";
    const world = new World(await load(), { gravity: [0, "-9.81", 0n] });
    const hit = castRay(world, [0, 1, 2], [0, -5, 0]);
    export const x: number | undefined = hit?.point[0];
    // @ts-expect-error: null where nothing is hit
    export const y: number = hit.point[0];
    // @ts-expect-error: no shape
    world.createBody({ position: [0, 0, 0] });
    // @ts-expect-error: two numbers are no place
    world.createBody({ shape: sphere(1), position: [0, 0] });
  `);
  const compiler = `${root}/build/web/node/node_modules/.bin/tsc`;
  const options = ["--noEmit", "--strict", "--module", "NodeNext", "--target", "ES2022", "--types", "", "types.mts"];
  execFileSync(compiler, options, { cwd: scratch, encoding: "utf8" });
});

test("the modules grow no further", () => {
  const sizes = [["lockstone", 346e3], ["lockstone-simd", 372e3], ["lockstone-session", 601e3], ["lockstone-session-simd", 623e3]];
  for (const [name, most] of sizes) {
    const file = `${name}.wasm`;
    const bytes = gzipSync(readFileSync(`${folder}/dist/${file}`), { level: 9 }).length;
    assert.ok(bytes < most, `${file}: ${bytes} bytes`);
  }
});
