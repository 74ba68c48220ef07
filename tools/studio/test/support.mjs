// The command, logs that it records, and its page in headless Chromium. LOCKSTONE_COMMAND names the command.
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
export const command = process.env.LOCKSTONE_COMMAND ?? `${root}/build/release/tools/lockstone`;
export const golden = JSON.parse(readFileSync(`${root}/tests/golden/scenes.json`, "utf8"));
export const scratch = mkdtempSync(join(tmpdir(), "lockstone-studio-"));
const CHROMIUM = process.env.LOCKSTONE_CHROMIUM ?? "/usr/bin/chromium";

export const skip = !existsSync(command) || !hasStudio() ? "the command has no studio" : !existsSync(CHROMIUM) ? "Chromium is not installed" : false;

function hasStudio() {
  return execFileSync(command, ["--help"], { encoding: "utf8" }).includes("Serve a page on this machine");
}

/** Records a log of the arena; its path and the hash after its last tick. */
export function record(name, ...options) {
  const path = join(scratch, name);
  const printed = execFileSync(command, ["record", path, "--match-id", "7", ...options], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  return { path, hash: /final hash ([0-9a-f]{16})/.exec(printed)?.[1] };
}

export function cleanUp() {
  rmSync(scratch, { recursive: true, force: true });
}

/** Runs `use(address)` while the command serves the files. */
export async function withStudio(files, use) {
  const server = spawn(command, ["studio", ...files], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const lines = createInterface({ input: server.stdout });
    const { value: address } = await lines[Symbol.asyncIterator]().next();
    return await use(address);
  } finally {
    server.kill("SIGINT");
  }
}

/** Runs `use(page)` with the page at an address; an error of it, or a request elsewhere, fails. */
export async function withPage(address, use, viewport = { width: 900, height: 600 }) {
  const { chromium } = createRequire(`${root}/build/studio/node/`)("playwright-core");
  const browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox"] });
  const wrong = [];
  try {
    const context = await browser.newContext({ viewport, acceptDownloads: true });
    const page = await context.newPage();
    page.on("pageerror", (error) => wrong.push(String(error)));
    page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
    page.on("request", (request) => {
      const { protocol, hostname } = new URL(request.url());
      if (protocol !== "blob:" && hostname !== "127.0.0.1") wrong.push(`asks for ${request.url()}`);
    });
    await page.goto(address);
    const result = await use(page);
    if (wrong.length > 0) throw new Error(wrong.join("\n"));
    return result;
  } finally {
    await browser.close();
  }
}

/** What a person does at the page, and sees. */
export function person(page) {
  const frames = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return {
    frames,
    async state() {
      await frames();
      return { tick: Number((await page.textContent("#tick-text")).split(" ")[1]), hash: await page.textContent("#hash-text") };
    },
    async press(key) {
      await page.keyboard.press(key);
      await frames();
    },
    async pause() {
      if ((await page.getAttribute("#play", "aria-pressed")) === "true") await page.keyboard.press("Space");
      await frames();
    },
    /** Goes to a tick by the slider. */
    async slide(tick) {
      await page.evaluate((wanted) => {
        const slider = document.getElementById("slider");
        slider.value = wanted;
        slider.dispatchEvent(new Event("input"));
      }, tick);
      await frames();
    },
    /** The picture, to be compared with another one, as soon as it stays the same: figures of one frame may change the next. */
    async picture() {
      for (let last = "";;) {
        await page.waitForTimeout(300);
        const now = await page.evaluate(() => document.getElementById("picture").toDataURL());
        if (now === last) return now;
        last = now;
      }
    },
    /** Counts pixels of the picture near a colour. */
    pixels: (red, green, blue, near = 30) => page.evaluate(([r, g, b, most]) => {
      const picture = document.getElementById("picture");
      const copy = Object.assign(document.createElement("canvas"), { width: picture.width, height: picture.height });
      const pen = copy.getContext("2d");
      pen.drawImage(picture, 0, 0);
      const { data } = pen.getImageData(0, 0, copy.width, copy.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (Math.abs(data[i] - r) < most && Math.abs(data[i + 1] - g) < most && Math.abs(data[i + 2] - b) < most) ++count;
      }
      return count;
    }, [red, green, blue, near]),
  };
}
