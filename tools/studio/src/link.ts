// The address of what is seen: view, scene, seed, tick, all that was done, camera, overlays.
import { type Action, actionOf, numbersOf } from "./action.js";
import type { Values } from "./parameters.js";

export interface Seen {
  scene: string;
  seed: bigint;
  /** Of the scene's parameters, by name. */
  values: Values;
  tick: number;
  /** Turn, rise, distance and target of the camera. */
  camera: number[];
  overlays: string[];
  colour: string;
  journal: Map<number, Action[]>;
}

/** Numbers of the journal, most of which repeat those of the action before: only differences are written. */
function packJournal(journal: ReadonlyMap<number, Action[]>): string {
  const lines: string[] = [];
  let before: bigint[] = [];
  for (const [tick, actions] of [...journal].sort(([a], [b]) => a - b)) {
    for (const action of actions) {
      const numbers = numbersOf(action);
      const text = numbers.map((n, i) => (n === before[i] ? "" : (n - (before[i] ?? 0n)).toString(36)));
      lines.push([tick.toString(36), ...text].join("."));
      before = numbers;
    }
  }
  return lines.join("_");
}

function parse36(text: string): bigint {
  const sign = text.startsWith("-") ? -1n : 1n;
  let value = 0n;
  for (const digit of text.replace("-", "")) value = value * 36n + BigInt(parseInt(digit, 36));
  return sign * value;
}

function unpackJournal(text: string): Map<number, Action[]> {
  const journal = new Map<number, Action[]>();
  let before: bigint[] = [];
  for (const line of text.split("_").filter(Boolean)) {
    const [tick = "0", ...differences] = line.split(".");
    before = differences.map((d, i) => (before[i] ?? 0n) + (d === "" ? 0n : parse36(d)));
    const at = parseInt(tick, 36);
    journal.set(at, [...(journal.get(at) ?? []), actionOf(before)]);
  }
  return journal;
}

export function linkOf(seen: Seen): string {
  const parts = new URLSearchParams({ scene: seen.scene, seed: String(seen.seed), tick: String(seen.tick) });
  parts.set("camera", seen.camera.map((x) => x.toFixed(3)).join(","));
  const values = Object.entries(seen.values);
  if (values.length > 0) parts.set("with", values.map((one) => one.join(":")).join(","));
  if (seen.overlays.length > 0) parts.set("show", seen.overlays.join(","));
  parts.set("colour", seen.colour);
  if (seen.journal.size > 0) parts.set("did", packJournal(seen.journal));
  return `#${parts}`;
}

/** Null for an address that names no scene. */
export function seenOf(hash: string): Seen | null {
  const parts = new URLSearchParams(hash.replace(/^#/, ""));
  const scene = parts.get("scene");
  if (!scene) return null;
  const whole = (name: string, fallback: string) => (/^\d+$/.test(parts.get(name) ?? "") ? parts.get(name)! : fallback);
  const pairs = (parts.get("with") ?? "").split(",").map((one) => one.split(":"));
  return {
    values: Object.fromEntries(pairs.filter(([, value]) => /^\d+$/.test(value ?? "")).map(([name, value]) => [name!, Number(value)])),
    scene, seed: BigInt(whole("seed", "1")), tick: Number(whole("tick", "0")),
    camera: (parts.get("camera") ?? "").split(",").filter(Boolean).map(Number),
    overlays: (parts.get("show") ?? "").split(",").filter(Boolean),
    colour: parts.get("colour") ?? "body",
    journal: unpackJournal(parts.get("did") ?? ""),
  };
}
