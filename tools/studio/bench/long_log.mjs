// How fast a log of ten minutes opens, and is scrubbed, in headless Chromium; prints rows of a table.
//
// usage: node long_log.mjs [TICKS]
import { median } from "./median.mjs";
import { cleanUp, record, withPage, withStudio } from "../test/support.mjs";

const TICKS = Number(process.argv[2] ?? 36_000), SCRUBS = 31;

/** Times of seeks to ticks that jump about, ms: of the first computation, until a picture is drawn, and until that of the exact tick is. */
async function scrub(page, until) {
  return page.evaluate(async ([most, count]) => {
    const slider = document.getElementById("slider"), computed = [], drawn = [], exact = [];
    const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    for (let i = 1; i <= count; ++i) {
      const began = performance.now();
      const wanted = Math.floor(((i * 0.61803398875) % 1) * most);
      slider.value = String(wanted);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      computed.push(performance.now() - began);
      await frame();
      drawn.push(performance.now() - began);
      while (document.getElementById("tick-text").textContent !== `tick ${wanted}`) await frame();
      exact.push(performance.now() - began);
      await new Promise((done) => setTimeout(done, 30));
    }
    return { computed, drawn, exact };
  }, [until, SCRUBS]);
}

const log = record("long.lks", "--ticks", String(TICKS), "--players", "16");
await withStudio([log.path], (address) => withPage("about:blank", async (page) => {
  const began = performance.now();
  await page.goto(address);
  await page.waitForSelector("#proof");
  await page.waitForFunction(() => document.getElementById("tick-text").textContent === "tick 0" && document.getElementById("hash-text").textContent !== "");
  const opened = performance.now() - began;
  const early = await scrub(page, TICKS);
  const provedFrom = performance.now();
  await page.waitForFunction((ticks) => document.getElementById("proof").textContent === `all ${ticks} ticks proved`, TICKS, { timeout: 1_200_000 });
  const proved = (performance.now() - provedFrom) / 1000;
  const late = await scrub(page, TICKS);

  console.log(`opened ${Math.round(opened)} ms, proved after ${proved.toFixed(0)} s`);
  for (const [name, { computed, drawn, exact }] of [["from keyframes", early], ["proved", late]]) {
    console.log(`scrub, ${name}: computed ${median(computed).toFixed(0)} ms, drawn ${median(drawn).toFixed(0)} ms, exact ${median(exact).toFixed(0)} ms (medians of ${SCRUBS}); worst drawn ${Math.max(...drawn).toFixed(0)} ms`);
  }
}));
cleanUp();
