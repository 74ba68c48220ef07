import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";

import { cleanUp, golden, person, scratch, skip, withPage, withStudio } from "./support.mjs";

after(cleanUp);

/** Where the selected body is, m. */
async function place(page) {
  await person(page).frames();
  return (await page.textContent("#body-position")).trim().split(/\s+/).slice(0, 3).map(Number);
}

test("scenes of the testbed have their golden hashes", { skip }, () => withStudio([], (address) => withPage(address, async (page) => {
  for (const name of ["wall", "ragdoll", "arena"]) {
    await page.goto(`${address}#scene=${name}&tick=20`);
    await page.waitForFunction((scene) => document.getElementById("scene-name")?.value === scene, name);
    await page.waitForFunction(() => document.getElementById("tick-text").textContent === "tick 20");
    assert.deepEqual(await person(page).state(), { tick: 20, hash: golden[name].chain[1] });
  }
})));

test("a pulled body follows the hand, and 600 ticks back and forth end in the same hash", { skip }, () => withStudio([], (address) =>
  withPage(`${address}#scene=stack&tick=60&camera=0.6,0.3,14,0,9.5,0`, async (page) => {
    const { frames, pause, press, state } = person(page);
    await page.waitForSelector("#scene-name");
    await pause();
    const before = await state();
    assert.equal(before.tick, 60);

    // The middle of the picture shows the box on top.
    const box = await page.locator("#picture").boundingBox();
    const middle = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    await page.mouse.move(middle.x, middle.y);
    await page.mouse.down();
    const from = await place(page);
    await page.mouse.move(middle.x, middle.y - 120, { steps: 4 });
    await page.waitForFunction(() => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > 90);
    const to = await place(page);
    await page.mouse.up();
    await pause();
    assert.ok(to[1] > from[1] + 0.5, `pulled from ${from} to ${to}`);

    await page.click("#throw");
    await pause();
    const thrown = await state();
    while ((await state()).tick < 660) await press("Shift+ArrowRight");
    const late = await state();
    await press("r");
    const early = await state();
    assert.equal(early.tick, late.tick - 600);
    if (early.tick === before.tick) assert.equal(early.hash, before.hash);
    for (let i = 0; i < 10; ++i) await press("Shift+ArrowRight");
    assert.deepEqual(await state(), late);
    await press("ArrowLeft");
    await press("ArrowRight");
    assert.deepEqual(await state(), late);
    assert.ok(thrown.tick < late.tick);

    // The link shows the same in another tab.
    await press("l");
    const other = await page.context().newPage();
    await other.goto(page.url());
    await other.waitForFunction((tick) => document.getElementById("tick-text").textContent === `tick ${tick}`, late.tick);
    assert.deepEqual(await person(other).state(), late);
    await other.close();
    await frames();
  })));

test("overlays are drawn, and bodies come and go", { skip }, () => withStudio([], (address) =>
  withPage(`${address}#scene=ragdoll&tick=240&show=triggers`, async (page) => {
    const { pause, pixels, press, frames } = person(page);
    await page.waitForSelector("#scene-name");
    await pause();
    await page.focus("#picture");
    for (const [key, colour] of [["1", [255, 59, 107]], ["2", [34, 193, 238]], ["3", [155, 123, 255]]]) {
      const before = await pixels(...colour);
      await press(key);
      await frames();
      const after = await pixels(...colour);
      assert.ok(after > before + 10, `overlay ${key}: ${before} pixels, then ${after}`);
    }
    const bodies = async () => Number(await page.textContent("#count-bodies"));
    const count = await bodies();
    await page.click("#drop");
    await page.waitForFunction((least) => Number(document.getElementById("count-bodies").textContent) > least, count);
    await pause();
    assert.equal(await bodies(), count + 1);
    await page.keyboard.press("t");
    await frames();
    assert.equal(await page.getAttribute("html", "data-theme"), "dark");
  })));

test("a scene of one's own is played, a wrong one is named, and a clip is saved", { skip }, () => withStudio([], (address) => withPage(address, async (page) => {
  const { press, state } = person(page);
  const drop = (scene) => page.setInputFiles("#scene-file", { name: "own.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify(scene)) });
  await page.waitForSelector("#scene-file");
  const own = {
    name: "two crates", gravity: [0, -9.81, 0],
    bodies: [
      { name: "ground", shape: { halfSpace: [] }, motion: "static" },
      { name: "crate", shape: { box: [0.5, 0.5, 0.5] }, position: [0, 2, 0], surface: { friction: "0.6" } },
      { shape: { hull: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }, position: [2, 3, 0], locks: ["turnY"] },
    ],
    joints: [{ kind: "hinge", a: "ground", b: "crate", frameA: { position: [0, 2, 0] }, angular: [{ mode: "limited", lower: -1, upper: 1 }] }],
  };
  await drop(own);
  await page.waitForFunction(() => document.getElementById("scene-text").textContent.startsWith("two crates"));
  await page.waitForFunction(() => document.getElementById("count-bodies").textContent === "3");
  assert.equal(await page.textContent("#count-joints"), "1");
  await page.waitForFunction(() => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > 30);
  await page.focus("#picture");
  await press("v");
  assert.equal(await page.getAttribute("#clip", "aria-pressed"), "true");
  await page.waitForFunction(() => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > 60);
  const [download] = await Promise.all([page.waitForEvent("download"), press("v")]);
  assert.match(download.suggestedFilename(), /^lockstone-ticks-\d+-\d+\.webm$/);
  await download.saveAs(join(scratch, "clip.webm"));
  const film = readFileSync(join(scratch, "clip.webm"));
  assert.ok(film.length > 5000 && film.readUInt32BE(0) === 0x1a45dfa3, `${film.length} bytes`);
  await drop({ ...own, bodies: [...own.bodies, { shape: { box: [1, 1] } }] });
  await page.waitForFunction(() => document.getElementById("told").textContent === "bodies[3]: box has 3 sizes");
  await drop({ ...own, bodies: [{ ...own.bodies[0], positon: [0, 0, 0] }] });
  await page.waitForFunction(() => document.getElementById("told").textContent === 'bodies[0]: there is no field "positon"');
  assert.ok((await state()).tick > 60);
})));

test("the stages of a tick have times, and change no hash", { skip }, () => withStudio([], (address) => withPage(`${address}#scene=wall&tick=20`, async (page) => {
  const { frames, pause, state } = person(page);
  await page.waitForFunction(() => document.getElementById("tick-text").textContent === "tick 20");
  await pause();
  assert.equal((await state()).hash, golden.wall.chain[1]);
  const time = async (stage) => Number(await page.textContent(`#stage-${stage}`));
  const times = Object.fromEntries(await Promise.all(["pairs", "collide", "solve", "move", "events"].map(async (stage) => [stage, await time(stage)])));
  assert.ok(times.solve > 0 && times.collide > 0, JSON.stringify(times));
  const whole = Number.parseFloat(await page.textContent("#chart-ms"));
  const sum = Object.values(times).reduce((all, ms) => all + ms, 0);
  assert.ok(whole > 0 && sum < 1000, `${sum} ms in stages, ${whole} ms the last tick`);
  await frames();
  // The solver's colour fills a part of the chart.
  const colored = await page.evaluate(() => {
    const canvas = document.getElementById("chart-stages");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 190 && data[i + 1] > 130 && data[i + 2] < 100 && data[i + 3] > 200) ++count;
    return count;
  });
  assert.ok(colored > 10, `${colored} pixels`);
})));

test("a scene is made with other numbers, and its link makes it again", { skip }, () => withStudio([], (address) => withPage(`${address}#scene=stack&tick=0`, async (page) => {
  const { frames, pause, press, state } = person(page);
  const bodies = async () => (await frames(), Number(await page.textContent("#count-bodies")));
  const enter = async (name, value) => {
    await page.fill(`#parameter-${name}`, String(value));
    await page.keyboard.press("Tab");
    await pause();
  };
  await page.waitForSelector("#parameter-boxes");
  assert.equal(await bodies(), 11);
  assert.deepEqual(await Promise.all(["boxes", "substeps", "gravity"].map((name) => page.inputValue(`#parameter-${name}`))), ["10", "4", "981"]);
  await enter("boxes", 20);
  assert.equal(await bodies(), 21);
  await enter("gravity", 162);
  await page.focus("#picture");
  while ((await state()).tick < 120) await press("ArrowRight");
  const here = await state();
  await press("l");
  assert.match(page.url(), /with=boxes%3A20%2Cgravity%3A162&/);
  const other = await page.context().newPage();
  await other.goto(page.url());
  await other.waitForFunction((tick) => document.getElementById("tick-text").textContent === `tick ${tick}`, here.tick);
  assert.deepEqual(await person(other).state(), here);
  assert.equal(await other.inputValue("#parameter-boxes"), "20");
  await other.close();
  // Back to the usual numbers, the scene has its golden hashes; a number out of its range is the nearest in it.
  await enter("boxes", 10);
  await enter("gravity", 981);
  await page.focus("#picture");
  while ((await state()).tick < 20) await press("ArrowRight");
  await page.focus("#picture");
  while ((await state()).tick > 20) await press("ArrowLeft");
  assert.equal((await state()).hash, golden.stack.chain[1]);
  await enter("boxes", 1000);
  assert.equal(await bodies(), 41);
  assert.equal(await page.inputValue("#parameter-boxes"), "40");
  for (const [scene, names] of [["chain", ["links", "times-heavier"]], ["wall", ["rows"]], ["ragdoll", ["ragdolls"]], ["arena", []]]) {
    await page.selectOption("#scene-name", scene);
    await frames();
    const shown = await page.$$eval("#parameters input", (inputs) => inputs.map((input) => input.id.replace("parameter-", "")));
    assert.deepEqual(shown, scene === "arena" ? [] : [...names, "substeps", "gravity"]);
  }
})));

test("the strip of hashes has a colour for each tick, green below it where the tick was computed again", { skip }, () => withStudio([], (address) => withPage(`${address}#scene=wall&tick=60`, async (page) => {
  const { frames, press } = person(page);
  await page.waitForFunction(() => document.getElementById("tick-text").textContent === "tick 60");
  await page.focus("#picture");
  await press("ArrowRight");
  /** Different colours of the strip, and green pixels below it. */
  const look = () => page.evaluate(() => {
    const canvas = document.getElementById("chart-hash"), pen = canvas.getContext("2d");
    const strip = pen.getImageData(0, 5, canvas.width, 1).data, below = pen.getImageData(0, canvas.height - 3, canvas.width, 1).data;
    const colours = new Set();
    let green = 0;
    for (let i = 0; i < strip.length; i += 4) {
      if (strip[i + 3] > 0) colours.add(strip.slice(i, i + 3).join());
      if (below[i] < 100 && below[i + 1] > 120 && below[i + 2] < 140) ++green;
    }
    return { colours: colours.size, green };
  });
  await frames();
  const once = await look();
  assert.ok(once.colours > 15 && once.green === 0, JSON.stringify(once));
  assert.equal(await page.textContent("#hash-verified"), "computed once");
  await press("Shift+ArrowLeft");
  for (let i = 0; i < 50; ++i) await page.keyboard.press("ArrowRight");
  await frames();
  const again = await look();
  assert.ok(again.green > 15, JSON.stringify(again));
  assert.equal(await page.textContent("#hash-verified"), "✓ computed again to tick 51");
  // Another future has hashes of its own.
  for (let i = 0; i < 20; ++i) await page.keyboard.press("ArrowLeft");
  await page.click("#drop");
  await page.waitForFunction(() => Number(document.getElementById("tick-text").textContent.split(" ")[1]) > 70);
  assert.equal(await page.textContent("#hash-verified"), "✓ computed again to tick 31");
})));

test("a picture of every tick is saved, none left out", { skip }, () => withStudio([], (address) => withPage(`${address}#scene=rolling&tick=20`, async (page) => {
  const { press } = person(page);
  await page.waitForFunction(() => document.getElementById("tick-text").textContent === "tick 20");
  await page.focus("#picture");
  await press("i");
  assert.equal(await page.getAttribute("#sequence", "aria-pressed"), "true");
  await press("Space");
  await page.waitForFunction(() => Number(document.getElementById("tick-text").textContent.split(" ")[1]) >= 30);
  const box = await page.evaluate(() => [document.getElementById("picture").width, document.getElementById("picture").height]);
  const [download] = await Promise.all([page.waitForEvent("download"), press("i")]);
  const archive = join(scratch, "sequence.zip");
  await download.saveAs(archive);
  const program = "import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); assert z.testzip() is None; [print(n, z.read(n).hex()) for n in z.namelist()]";
  const files = execFileSync("python3", ["-c", program, archive], { encoding: "utf8", maxBuffer: 1 << 28 }).trim().split("\n").map((line) => line.split(" "));
  assert.ok(files.length >= 10 && download.suggestedFilename() === `lockstone-${files.length}-ticks.zip`);
  assert.deepEqual(files.map(([name]) => name), files.map((_, i) => `tick-${String(20 + i).padStart(6, "0")}.png`));
  for (const [name, hex] of files) {
    const png = Buffer.from(hex, "hex");
    assert.equal(png.subarray(1, 4).toString(), "PNG", name);
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], box);
  }
  assert.ok(new Set(files.map(([, hex]) => hex)).size > files.length / 2, "the ball rolls");
})));

test("the page fits a phone", { skip }, () => withStudio([], (address) => withPage(address, async (page) => {
  await page.waitForSelector("#scene-name");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${wide} px too wide`);
  const { height } = await page.locator("#picture").boundingBox();
  assert.ok(height > 250, `the picture is ${height} px high`);
}, { width: 390, height: 844 })));

test("the server tells nobody else anything", { skip }, () => withStudio([], async (address) => {
  const answer = await fetch(address);
  const policy = answer.headers.get("content-security-policy");
  assert.match(policy, /^default-src 'none';/);
  assert.doesNotMatch(policy, /unsafe-inline|unsafe-eval(?<!wasm-unsafe-eval)|\*/);
  assert.equal(answer.headers.get("cache-control"), "no-store");
  const { origin, port } = new URL(address);
  assert.equal((await fetch(`${origin}/`)).status, 404);
  assert.equal((await fetch(`${origin}/${"0".repeat(32)}/`)).status, 404);
  assert.equal((await fetch(`${address}../index.html`)).status, 404);
  await assert.rejects(fetch(`http://127.0.0.2:${port}/`));
}));
