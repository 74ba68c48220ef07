// A log that the native command records, computed again in WebAssembly. LOCKSTONE_COMMAND names the command.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { full, root } from "./support.mjs";

const builds = ["release", "demo"].map((preset) => `${root}/build/${preset}/tools/lockstone`);
const command = process.env.LOCKSTONE_COMMAND ?? builds.find((path) => existsSync(path));
const skip = command ? false : "there is no native command";

test("a native log has the same hashes in WebAssembly, and a changed one does not", { skip }, async () => {
  const scratch = mkdtempSync(join(tmpdir(), "lockstone-log-"));
  const record = (name, ...options) => {
    execFileSync(command, ["record", join(scratch, name), "--plain", "--ticks", "60", ...options], { stdio: "pipe" });
    return readFileSync(join(scratch, name));
  };
  try {
    const lockstone = await full.loadFull();
    const report = full.verifyLog(lockstone, record("same.lks"));
    assert.deepEqual([report.outcome, report.ticksVerified, report.complete, report.divergence], ["same", 60, true, null]);
    const wrong = full.verifyLog(lockstone, record("wrong.lks", "--flip-bit-at", "30"));
    assert.deepEqual([wrong.outcome, wrong.divergence?.tick], ["diverged", 30]);
    assert.equal(full.verifyLog(lockstone, new Uint8Array(100)).outcome, "corrupt");
  } finally {
    rmSync(scratch, { recursive: true });
  }
});
