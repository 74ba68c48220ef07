// The native side of a match: `lockstone serve`, `join`, `lossy`, `token`.
import { spawn, spawnSync } from "node:child_process";
import { createRequire } from "node:module";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../../..", import.meta.url));

const builds = ["release", "demo"].map((preset) => `${root}/build/${preset}/tools/lockstone`);
export const command = process.env.LOCKSTONE_COMMAND ?? builds.find((path) => existsSync(path));

/** Whether the command can host players in browsers. */
export function hostsBrowsers() {
  return command !== undefined && spawnSync(command, ["serve", "--help"], { encoding: "utf8" }).stdout.includes("--ws ");
}

/** A program that runs, and its output so far. */
export class Program {
  constructor(...args) {
    this.text = "";
    this.process = spawn(command, args, { stdio: ["ignore", "pipe", "pipe"] });
    this.ended = new Promise((resolve) => this.process.on("close", resolve));
    for (const stream of [this.process.stdout, this.process.stderr])
      stream.on("data", (data) => { this.text += data; });
  }

  /** The match of a pattern in the output, as soon as there is one. */
  async says(pattern, seconds = 30) {
    const end = Date.now() + 1000 * seconds;
    for (;;) {
      const found = pattern.exec(this.text);
      if (found) return found;
      if (Date.now() > end || this.process.exitCode !== null) throw new Error(`no ${pattern} in:\n${this.text}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  kill() {
    if (this.process.exitCode === null) this.process.kill();
  }
}

/**
 * A client that has no network (tools/web/native/stdio_client.cpp), brought into a match over a WebSocket. LOCKSTONE_EMULATED
 * is the command that runs it, under an emulator for instance.
 */
export class StdioClient {
  constructor(url, token) {
    const [program, ...args] = process.env.LOCKSTONE_EMULATED.split(" ");
    const { WebSocket } = createRequire(`${root}/build/web/node/`)("ws");
    this.text = "";
    this.process = spawn(program, [...args, token, "1"], { stdio: ["pipe", "pipe", "pipe"] });
    this.process.stderr.on("data", (data) => { this.text += data; });
    this.process.stdin.on("error", () => {}); // it has ended
    const socket = new WebSocket(url, "lockstone");
    const opened = new Promise((resolve) => socket.on("open", resolve));
    let waiting = Buffer.alloc(0);
    this.process.stdout.on("data", async (data) => {
      waiting = Buffer.concat([waiting, data]);
      await opened;
      for (let size; waiting.length >= 4 && waiting.length >= 4 + (size = waiting.readUInt32LE(0)); waiting = waiting.subarray(4 + size))
        socket.send(waiting.subarray(4, 4 + size));
    });
    socket.on("message", (message) => {
      const head = Buffer.alloc(4);
      head.writeUInt32LE(message.length);
      this.process.stdin.write(Buffer.concat([head, message]));
    });
    socket.on("close", () => this.process.stdin.end());
    this.ended = new Promise((resolve) => this.process.on("close", resolve)).then(() => socket.close());
  }

  kill() {
    if (this.process.exitCode === null) this.process.kill();
  }
}

/** A folder with a backend's key; tokens of match 1 for its seats. */
export class Backend {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), "lockstone-match-"));
    this.key = join(this.folder, "key");
    spawnSync(command, ["token", "key", this.key]);
  }

  /** The name of the file with the token of a slot, or of "spectator". */
  token(slot) {
    const file = join(this.folder, `${slot}.token`);
    if (existsSync(file)) return file;
    const issued = spawnSync(command, ["token", "issue", "--key", this.key, "--match", "1", "--player", `${slot === "spectator" ? 99 : 100 + slot}`,
      "--slot", `${slot}`, "--out", file], { encoding: "utf8" });
    if (issued.status !== 0) throw new Error(issued.stderr);
    return file;
  }

  tokenText(slot) {
    return readFileSync(this.token(slot), "utf8").trim();
  }

  remove() {
    rmSync(this.folder, { recursive: true });
  }
}

/** A server for a match, with everything that plays in it; all of them end with `use`. Tokens are asked for unless it is `--insecure`. */
export async function withMatch(options, use) {
  const backend = new Backend();
  const programs = [];
  const keep = (program) => (programs.push(program), program);
  const run = (...args) => keep(new Program(...args));
  try {
    const door = options.includes("--insecure") ? [] : ["--key", backend.key, "--match", "1"];
    const server = run("serve", ...door, "--ws", "0", ...options);
    const port = Number((await server.says(/listening on 127\.0\.0\.1:(\d+)/))[1]);
    const url = (await server.says(/listening on (wss?:\S+)/))[1];
    return await use({ backend, run, keep, server, port, url });
  } catch (error) {
    error.message += `\n${programs.map((program) => program.text).join("\n")}`;
    throw error;
  } finally {
    for (const program of programs) program.kill();
    await Promise.all(programs.map((program) => program.ended));
    backend.remove();
  }
}
