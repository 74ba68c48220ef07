import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";

import { cleanUp, person, record, scratch, skip, withPage, withStudio } from "./support.mjs";

after(cleanUp);

const TICKS = 600, FLIPPED = 300;
const good = skip ? null : record("good.lks", "--ticks", String(TICKS));
const flipped = skip ? null : record("flipped.lks", "--ticks", String(TICKS), "--flip-bit-at", String(FLIPPED));

test("a log is proved, scrubbed and saved as a picture", { skip }, () => withStudio([good.path], (address) => withPage(address, async (page) => {
  const { frames, picture, press, slide, state } = person(page);
  // Before the worker has come by: the page goes on drawing while it computes.
  await page.waitForSelector("#proof");
  await slide(TICKS);
  await page.waitForFunction((ticks) => document.getElementById("tick-text").textContent === `tick ${ticks}`, TICKS);
  assert.deepEqual(await state(), { tick: TICKS, hash: good.hash });
  await slide(0);
  await page.waitForFunction((ticks) => document.getElementById("proof")?.textContent === `all ${ticks} ticks proved`, TICKS);
  await slide(TICKS);
  assert.deepEqual(await state(), { tick: TICKS, hash: good.hash });
  assert.equal(await page.textContent("#proof-text"), "✓ as recorded");

  // A finger on the timeline.
  const lane = await page.locator("#timeline").boundingBox();
  await page.mouse.move(lane.x + lane.width / 4, lane.y + 20);
  await page.mouse.down();
  await page.mouse.move(lane.x + lane.width / 2, lane.y + 20, { steps: 5 });
  await page.mouse.up();
  const { tick, hash } = await state();
  assert.ok(Math.abs(tick - TICKS / 2) <= 2, `tick ${tick}`);
  await press("ArrowRight");
  await press("ArrowLeft");
  assert.deepEqual(await state(), { tick, hash });
  assert.match(await page.textContent("#input-player-0"), /^received {2}move -?\d+ -?\d+ {2}aim/);
  const green = await page.evaluate(() => [...document.getElementById("timeline").getContext("2d").getImageData(200, 2, 1, 1).data]);
  assert.deepEqual(green, [26, 143, 76, 255]);

  // The camera goes to a player, and moves along with it.
  const unfollowed = await picture();
  await page.selectOption("#follow-player", "player 1");
  const followed = await picture();
  assert.ok(followed !== unfollowed, "the camera stays");
  await page.selectOption("#follow-player", "nobody");
  assert.ok(await picture() === followed, "the camera moves");

  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#shoot")]);
  assert.equal(download.suggestedFilename(), `lockstone-tick-${tick}.png`);
  await download.saveAs(join(scratch, "picture.png"));
  assert.equal(readFileSync(join(scratch, "picture.png")).subarray(1, 4).toString(), "PNG");
  await frames();
})));

test("a log with a fault says where it is", { skip }, () => withStudio([flipped.path], (address) => withPage(address, async (page) => {
  const { press, state } = person(page);
  await page.waitForFunction(() => document.getElementById("proof")?.textContent.includes("another hash"));
  assert.equal(await page.textContent("#proof"), `tick ${FLIPPED} comes to another hash here`);
  await press("n");
  assert.equal((await state()).tick, FLIPPED + 1);
  assert.equal(await page.textContent("#proof-text"), "✗ not as recorded");
})));

async function checkDesync(page) {
  const { picture, pixels, press, slide, frames } = person(page);
  await page.waitForSelector("#verdict");
  await frames();
  assert.match(await page.textContent("#verdict strong"), new RegExp(`They part in tick ${FLIPPED}$`));
  assert.match(await page.textContent("#desync-field"), /^\w+/);
  assert.match(await page.textContent("#desync-here"), /^0x[0-9a-f]+/);
  assert.notEqual(await page.textContent("#desync-here"), await page.textContent("#desync-there"));
  assert.match(await page.textContent("#compare-status"), /Tick 301: 1 body differs/);
  const body = /^body (\d+)/.exec(await page.textContent("#desync-object"))[1];
  assert.equal(await page.textContent("#differing tr:first-child td"), body);
  assert.match(await page.textContent("#next-step"), /\w/);
  const yellow = await pixels(255, 250, 90, 40);
  assert.ok(yellow > 20, `${yellow} yellow pixels`);

  // One world in the other, and back.
  const beside = await picture();
  await page.focus("#picture");
  await press("o");
  assert.ok(await page.isChecked("#overlaid"));
  assert.ok(await picture() !== beside, "the worlds stay beside each other");
  assert.ok(await pixels(255, 250, 90, 40) > 20);
  await press("o");
  assert.ok(await picture() === beside, "the worlds stay in one picture");

  await page.click("#go-before");
  await frames();
  assert.match(await page.textContent("#compare-status"), /Tick 300: both are equal, bit for bit/);
  assert.equal(await page.locator("#differing tr").count(), 0);
  const [here, there] = (await page.locator("#labels span").allTextContents()).map((text) => text.split(" ").at(-1));
  assert.equal(here, there);
  await press("n");
  await press("ArrowRight");
  assert.match(await page.textContent("#compare-status"), /Tick 302: \d+ bod(y|ies) differ/);
  // One body began, and each other one had it from a body that differed before.
  const titles = await page.locator("#infection title").allTextContents();
  assert.deepEqual(titles.filter((text) => text.includes("the first")), [`body ${body}, tick ${FLIPPED + 1}, the first`]);
  await slide(FLIPPED + 2);
  const apart = (await page.locator("#labels span").allTextContents()).map((text) => text.split(" ").at(-1));
  assert.notEqual(apart[0], apart[1]);
  return apart;
}

test("a difference spreads in a ragdoll, from body to body", { skip }, () => {
  const ragdoll = (name, ...options) => record(name, "--scene", "ragdoll", "--ticks", "240", ...options).path;
  return withStudio([ragdoll("ragdoll.lks"), ragdoll("flipped-ragdoll.lks", "--flip-bit-at", "100")], (address) => withPage(address, async (page) => {
    await page.waitForSelector("#infection title", { state: "attached" });
    const titles = await page.locator("#infection title").allTextContents();
    const infected = titles.map((text) => /^body (\d+), tick (\d+), (?:the first|from body ([\d, ]+))$/.exec(text).slice(1))
      .map(([body, tick, from = ""]) => ({ body, tick: Number(tick), from: from.split(", ").filter(Boolean) }));
    assert.ok(infected.length > 5, `${titles}`);
    assert.deepEqual(infected[0].from, []);
    const since = new Map(infected.map(({ body, tick }) => [body, tick]));
    for (const { tick, from } of infected) for (const source of from) assert.ok(since.get(source) <= tick);
    assert.ok(infected.filter(({ from }) => from.length > 0).length > infected.length / 2, `${titles}`);
  }));
});

test("two logs of one match part where a bit was flipped, and a bundle shows the same", { skip }, () =>
  withStudio([good.path, flipped.path], async (address) => {
    const apart = await withPage(address, checkDesync);

    // A bundle as `serve --bundle` writes it.
    for (const side of ["here", "there"]) {
      writeFileSync(join(scratch, `${side}.snapshot`), Buffer.from(await (await fetch(`${address}state/${side}`)).arrayBuffer()));
    }
    writeFileSync(join(scratch, "report.txt"), `tick ${FLIPPED}, player 2, a line for people\nverdict: there\n`);
    execFileSync("cp", [good.path, join(scratch, "match.lks")]);
    const bundle = join(scratch, "bundle.tar");
    execFileSync("tar", ["--format=ustar", "-cf", bundle, "-C", scratch, "report.txt", "here.snapshot", "there.snapshot", "match.lks"]);
    await withStudio([bundle], async (other) => assert.deepEqual(await withPage(other, checkDesync), apart));
  }));
