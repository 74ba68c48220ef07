// A tab of headless Chromium, driven through pipes: as much as a brief test needs, without a package of npm. LOCKSTONE_CHROMIUM
// names the program.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const PROGRAMS = ["/usr/bin/chromium", "/usr/bin/chromium-headless-shell"];
const OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--remote-debugging-pipe"];
const LONGEST_WAIT_MS = 60_000;

/** Calls and answers of the browser's protocol: JSON, each ended by a zero byte. */
class Protocol {
  constructor(input, output) {
    this.output = output;
    this.waiting = new Map();
    this.heard = () => {};
    this.last = 0;
    let text = "";
    input.setEncoding("utf8").on("data", (data) => {
      const messages = (text + data).split("\0");
      text = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
    input.on("end", () => this.waiting.forEach(({ reject }) => reject(new Error("the browser has ended"))));
    output.on("error", () => {}); // it has ended
  }

  call(method, params = {}, sessionId = undefined) {
    const id = ++this.last;
    this.output.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  take({ id, result, error, method, params }) {
    const caller = this.waiting.get(id);
    this.waiting.delete(id);
    if (!caller) this.heard(method, params);
    else if (error) caller.reject(new Error(error.message));
    else caller.resolve(result);
  }
}

class Tab {
  constructor(protocol, session) {
    this.call = (method, params) => protocol.call(method, params, session);
    this.errors = [];
    this.loaded = () => {};
    protocol.heard = (method, params) => {
      if (method === "Page.loadEventFired") this.loaded();
      if (method === "Runtime.exceptionThrown") this.errors.push(textOf(params.exceptionDetails));
    };
  }

  goto(url) {
    return this.load("Page.navigate", { url });
  }

  reload() {
    return this.load("Page.reload", {});
  }

  /** The result of a function in the page, which may be a promise; `value` is its argument. */
  async evaluate(use, value = null) {
    const expression = `(${use})(${JSON.stringify(value)})`;
    const { result, exceptionDetails } = await this.call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(textOf(exceptionDetails));
    return result.value;
  }

  async waitFor(test, value = null) {
    for (const end = Date.now() + LONGEST_WAIT_MS; !(await this.evaluate(test, value));) {
      if (Date.now() > end) throw new Error(`not within ${LONGEST_WAIT_MS} ms: ${test}`);
      await new Promise((done) => setTimeout(done, 20));
    }
  }

  async load(method, params) {
    const loaded = new Promise((done) => (this.loaded = done));
    await this.call(method, params);
    await loaded;
  }
}

function textOf({ text, exception }) {
  return exception?.description ?? text;
}

/** Runs `use` with a tab of a new browser; an error of the page's fails it. */
export async function withTab(use) {
  const program = process.env.LOCKSTONE_CHROMIUM ?? PROGRAMS.find((path) => existsSync(path));
  const profile = mkdtempSync(join(tmpdir(), "lockstone-browser-"));
  // Some programs are scripts that start the browser: the whole group of processes is ended, at once,
  // or one of them writes into the profile while it is removed.
  const browser = spawn(program, [...OPTIONS, `--user-data-dir=${profile}`], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], detached: true });
  const ended = new Promise((resolve) => browser.on("close", resolve));
  try {
    const protocol = new Protocol(browser.stdio[4], browser.stdio[3]);
    const { targetId } = await protocol.call("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await protocol.call("Target.attachToTarget", { targetId, flatten: true });
    const tab = new Tab(protocol, sessionId);
    await Promise.all([tab.call("Page.enable"), tab.call("Runtime.enable")]);
    const result = await use(tab);
    if (tab.errors.length > 0) throw new Error(tab.errors.join("\n"));
    return result;
  } finally {
    process.kill(-browser.pid, "SIGKILL");
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  }
}
