// How many pictures a second the testbed draws while it plays scenes of 1,000 bodies, in headless Chromium, which draws by the
// processor; and the processor time of each. Prints medians.
//
// usage: node frames.mjs [RUNS]
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";

import { median } from "./median.mjs";
import { cleanUp, withPage, withStudio } from "../test/support.mjs";

const RUNS = Number(process.argv[2] ?? 5), WARM_UP = 30, FRAMES = 60;
const SCENES = { wall: "scene=wall&with=rows:44&tick=1", pile: "scene=pile&with=layers:62&tick=60" };
const TICK_S = 1 / Number(execFileSync("getconf", ["CLK_TCK"], { encoding: "utf8" }));

/** Processor time of all processes below one, s. */
function processorTime(root) {
  const parents = new Map(), times = new Map();
  for (const name of readdirSync("/proc").filter((one) => /^\d+$/.test(one))) {
    try {
      const fields = readFileSync(`/proc/${name}/stat`, "utf8").replace(/^.*\) /s, "").split(" ");
      parents.set(Number(name), Number(fields[1]));
      times.set(Number(name), TICK_S * (Number(fields[11]) + Number(fields[12])));
    } catch {
      // It has ended.
    }
  }
  const isBelow = (one) => one === root || (parents.has(one) && parents.get(one) !== 0 && isBelow(parents.get(one)));
  return [...times].filter(([one]) => one !== root && isBelow(one)).reduce((sum, [, time]) => sum + time, 0);
}

/** Of the next FRAMES pictures: how many a second, and processor time, ms, and ticks of each. */
async function measure(page) {
  await page.evaluate(async (frames) => {
    for (let i = 0; i < frames; ++i) await new Promise((done) => requestAnimationFrame(done));
  }, WARM_UP);
  const before = processorTime(process.pid);
  const { seconds, ticks } = await page.evaluate(async (frames) => {
    const tick = () => Number(document.getElementById("tick-text").textContent.split(" ")[1]);
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const began = await frame(), from = tick();
    let last = began;
    for (let i = 0; i < frames; ++i) last = await frame();
    return { seconds: (last - began) / 1000, ticks: tick() - from };
  }, FRAMES);
  const used = processorTime(process.pid) - before;
  return { rate: FRAMES / seconds, used: (1000 * used) / FRAMES, ticks: ticks / FRAMES };
}

async function run(fragment) {
  return withStudio([], (address) => withPage(`${address}#${fragment}`, async (page) => {
    const start = `tick ${/tick=(\d+)/.exec(fragment)[1]}`;
    await page.waitForFunction((text) => document.getElementById("tick-text").textContent === text, start, { timeout: 120_000 });
    await page.focus("#picture");
    await page.keyboard.press("Space");
    const bodies = await page.textContent("#count-bodies");
    return { bodies, ...(await measure(page)) };
  }));
}

for (const [name, fragment] of Object.entries(SCENES)) {
  const rows = [];
  for (let i = 0; i < RUNS; ++i) rows.push(await run(fragment));
  const middle = (figure) => median(rows.map((row) => row[figure]));
  console.log(`${name}, ${rows[0].bodies} bodies: ${middle("rate").toFixed(1)} frames a second, ${middle("used").toFixed(0)} ms of processor time and ${middle("ticks").toFixed(1)} ticks a frame (medians of ${RUNS})`);
}
cleanUp();
