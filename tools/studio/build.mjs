// Bundles the page into a folder, each file compressed: the command embeds them and serves them as they are.
//
// usage: node build.mjs MODULE.wasm FOLDER
import { createRequire } from "node:module";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = fileURLToPath(new URL(".", import.meta.url));
const modules = `${here}/../../build/studio/node/node_modules`;
const { build } = createRequire(`${modules}/`)("esbuild");
const [wasm, folder] = process.argv.slice(2);

const bundle = await build({
  entryPoints: { studio: `${here}src/main.ts`, prover: `${here}src/prover.ts` },
  outdir: folder, bundle: true, format: "esm", target: "es2022", minify: true, legalComments: "eof", nodePaths: [modules],
  write: false, logLevel: "warning",
  external: ["node:fs/promises"],
});
const files = new Map(bundle.outputFiles.map(({ path, contents }) => [path.split("/").pop(), contents]));
for (const name of ["index.html", "studio.css", "icon.svg"]) files.set(name, readFileSync(`${here}src/${name}`));
files.set("lockstone-studio.wasm", readFileSync(wasm));

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
let sum = 0;
for (const [name, contents] of files) {
  const packed = gzipSync(contents, { level: 9 });
  sum += packed.length;
  writeFileSync(`${folder}/${name}.gz`, packed);
}
console.error(`${files.size} files, ${Math.round(sum / 1024)} KiB compressed, in ${folder}`);
