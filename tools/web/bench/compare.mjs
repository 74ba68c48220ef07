// Size, load time and ticks of the npm package beside other engines, under this Node.
//
// usage: node compare.mjs [--repeats N] [--page FILE]
//
// Each measurement is a process of its own, and the engines take turns. --page writes a page of the
// documentation; the figures are printed in any case.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { cpus } from "node:os";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { gzipSync } from "node:zlib";

import { engines } from "./engines.mjs";
import { bodies, posesTime } from "./poses.mjs";
import { HALF, ROWS, TICKS, pyramid } from "./scene.mjs";

const { values: options } = parseArgs({
  options: { repeats: { type: "string", default: "7" }, page: { type: "string" }, engine: { type: "string" } },
});

function quantile(values, part) {
  return [...values].sort((a, b) => a - b)[Math.floor(part * (values.length - 1))];
}

/** One engine in this process. */
async function measure(engine) {
  const begun = performance.now();
  const loaded = await engine.load();
  const ready = performance.now();
  const scene = engine.make(loaded);
  const ticks = [];
  for (let i = 0; i < TICKS; ++i) {
    const before = performance.now();
    scene.step();
    ticks.push(performance.now() - before);
  }
  const [x, y, z] = scene.top();
  return {
    load: ready - begun, first: ticks[0], median: quantile(ticks, 0.5), p99: quantile(ticks, 0.99),
    moved: Math.hypot(x, y - (2 * ROWS - 1) * HALF, z), hash: scene.hash?.(),
  };
}

/** Sizes of the files, packed as servers send them. */
function sizes(files) {
  const all = files.map((file) => readFileSync(file));
  const sum = (bytes) => bytes.reduce((a, b) => a + b, 0);
  return { plain: sum(all.map((file) => file.length)), packed: sum(all.map((file) => gzipSync(file, { level: 9 }).length)) };
}

function inProcess(name) {
  const self = fileURLToPath(import.meta.url);
  return JSON.parse(execFileSync(process.execPath, [self, "--engine", name], { encoding: "utf8" }));
}

function row(name, runs) {
  const engine = engines[name];
  const { plain, packed } = sizes(engine.files);
  const middle = (figure) => quantile(runs.map((run) => run[figure]), 0.5);
  return [
    `${engine.name} ${engine.version}`, `${Math.round(plain / 1000)}`, `${Math.round(packed / 1000)}`,
    middle("load").toFixed(1), middle("first").toFixed(1), middle("median").toFixed(2), middle("p99").toFixed(2),
    (middle("moved") * 1000).toFixed(1),
  ].join(" | ");
}

async function table() {
  const repeats = Number(options.repeats);
  const names = Object.keys(engines);
  const runs = Object.fromEntries(names.map((name) => [name, []]));
  for (let i = 0; i < repeats; ++i) for (const name of names) runs[name].push(inProcess(name));
  for (const same of [["simd", "plain"], ["iterated"]]) {
    const hashes = new Set(same.flatMap((name) => runs[name]).map(({ hash }) => hash));
    if (hashes.size !== 1) throw new Error(`runs of ours end in different states: ${[...hashes].join(", ")}`);
  }
  const poses = await posesTime();
  return [
    "| engine | size, kB | gzipped, kB | load, ms | first tick, ms | tick, ms | p99, ms | top box moved, mm |",
    "|---|---|---|---|---|---|---|---|",
    ...names.map((name) => `| ${row(name, runs[name])} |`),
    "",
    `Our final hash, with vectors and without: \`${runs.simd[0].hash}\`; iterated: \`${runs.iterated[0].hash}\`. Node ${process.versions.node}, ${cpus()[0].model}.`,
    "",
    `Poses of ${bodies.toLocaleString("en")} moving bodies, a frame, with vectors (median of 200): raw integers by \`World.poses\` ${poses.raw.toFixed(3)} ms; in`,
    `floating point between ticks by \`View.at\` ${poses.at.toFixed(3)} ms, and \`View.update\` ${poses.update.toFixed(3)} ms a tick. The arrays lie in the`,
    "module's memory: nothing is copied.",
  ].join("\n");
}

const page = (text) => `# The npm package beside other engines

\`\`\`sh
tools/web.sh bench
\`\`\`

writes this page: it builds the package, installs the others from the npm registry (versions in \`tools/web/npm/package.json\`), and
measures all of them under Node, each repeat in a process of its own, the engines in turns. Figures are medians over ${options.repeats} repeats.

${text}

- **The scene** (\`tools/web/bench/scene.mjs\`): a pyramid of ${pyramid().length} boxes of 1 m, ${ROWS} in the lowest row, friction 0.6, ${TICKS} ticks at 60 Hz. Every engine is at
  its defaults, but that nothing sleeps. Ours solves the pyramid to convergence in each of four substeps a tick; *iterated* is
  \`convergedContacts: 0\`, an iterative solver as the others have it.
- **Size**: the files that a browser must fetch: JavaScript and WebAssembly. Ours is the core, \`lockstone\`: all of its modules, as they are, without
  a bundler. Rapier's \`compat\` packages hold their WebAssembly as text; Jolt's is the package's \`jolt-physics/wasm\`. Gzip at its highest level.
- **Load**: from \`import\` until the engine can make a world. **Tick**: the median and the 99th percentile over the ticks, the first one
  included. **Top box moved**: after the last tick, against where it was put: an engine that lets the pyramid sink or slide has done less work.
- **Our median** is that of a pyramid at rest: from tick 38 on all of its boxes stand still, and islands that stand still are left out of the tick, though
  nothing sleeps. Compare the first tick and the 99th percentile; \`stillBodies\` of \`stepWithReport\` tells.
- **Size of the core's WebAssembly**: at most 350 kB packed without vectors, which \`tools/web.sh test\` checks; with vectors it is 26 kB more
  ([how](../notes/webassembly.md)). The rows above hold the package's JavaScript as well.
- Rapier's \`deterministic\` package and ours give the same bits on every machine; the other two do not promise it. Ours also equals its native builds.
`;

if (options.engine) {
  console.log(JSON.stringify(await measure(engines[options.engine])));
} else {
  const text = await table();
  console.log(text);
  if (options.page) writeFileSync(options.page, page(text));
}
