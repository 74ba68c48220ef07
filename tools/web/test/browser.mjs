// A page in headless Chromium that can import the package.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";

import { root } from "./support.mjs";
import { serve } from "./server.mjs";

const PROGRAMS = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const chromium = process.env.LOCKSTONE_CHROMIUM ?? PROGRAMS.find((path) => existsSync(path));

/** Runs `use` with a page at `path` of the server; a message or an error of the page fails it. */
export async function withPage(path, use) {
  const require = createRequire(`${root}/build/web/node/`);
  const server = await serve();
  const browser = await require("playwright-core").chromium.launch({ executablePath: chromium, args: ["--no-sandbox"] });
  try {
    const page = await browser.newPage({ viewport: { width: 1000, height: 700 } });
    const errors = [];
    page.on("pageerror", (error) => errors.push(String(error)));
    await page.goto(`http://127.0.0.1:${server.address().port}${path}`);
    const result = await use(page);
    if (errors.length > 0) throw new Error(errors.join("\n"));
    return result;
  } finally {
    await browser.close();
    server.close();
  }
}
