// A page in headless Chromium that can import the package.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";

import { root } from "./support.mjs";
import { serve } from "./server.mjs";

const PROGRAMS = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const chromium = process.env.LOCKSTONE_CHROMIUM ?? PROGRAMS.find((path) => existsSync(path));

/** Runs `use` with so many tabs, whose `origin` is that of the server; a message or an error of a tab fails it. */
export async function withPages(count, use) {
  const require = createRequire(`${root}/build/web/node/`);
  const server = await serve();
  const browser = await require("playwright-core").chromium.launch({ executablePath: chromium, args: ["--no-sandbox"] });
  try {
    const errors = [];
    const context = await browser.newContext({ viewport: { width: 1000, height: 700 } });
    const pages = await Promise.all(Array.from({ length: count }, () => context.newPage()));
    for (const page of pages) {
      page.origin = `http://127.0.0.1:${server.address().port}`;
      page.on("pageerror", (error) => errors.push(error.stack ?? String(error)));
    }
    const result = await use(pages);
    if (errors.length > 0) throw new Error(errors.join("\n"));
    return result;
  } finally {
    await browser.close();
    server.close();
  }
}

/** The same with one tab, at `path` of the server. */
export function withPage(path, use) {
  return withPages(1, async ([page]) => {
    await page.goto(page.origin + path);
    return use(page);
  });
}
