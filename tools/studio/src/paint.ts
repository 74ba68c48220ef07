// Colours of bodies.
import * as three from "three";
import type { Painter } from "./bodies.js";
import { State } from "./engine.js";

export const COLOURINGS = ["body", "island", "activity"] as const;
export type Colouring = (typeof COLOURINGS)[number];

const PALETTE = [0x4e79a7, 0xf28e2b, 0xe15759, 0x76b7b2, 0x59a14f, 0xedc948, 0xb07aa1, 0x9c755f].map((hex) => new three.Color(hex));
/** Of bodies that never move: the page's theme sets it. */
export const FIXED = new three.Color(0x8a949e);
const KINEMATIC = new three.Color(0x3aa6a0), TRIGGER = new three.Color(0x42c864);
const ASLEEP = new three.Color(0x5b6b86), AWAKE = new three.Color(0xf08a24), SELECTED = new three.Color(0xffffff);
const SAME = new three.Color(0x7d8894);

/** The colour of an island, the same in the legend: spread over the circle of hues. */
export function islandColor(island: number, out: three.Color): three.Color {
  return out.setHSL((island * 0.61803398875) % 1, 0.62, 0.55);
}

function paintBody(row: number, state: number, out: three.Color): void {
  if (state === State.fixed) out.copy(FIXED);
  else if (state === State.kinematic) out.copy(KINEMATIC);
  else if (state === State.trigger) out.copy(TRIGGER);
  else out.copy(PALETTE[row % PALETTE.length]!);
}

/** `chosen` gives the row of the selected body. */
export function painterOf(colouring: () => Colouring, sleepShown: () => boolean, chosen: () => number): Painter {
  return (row, state, island, out) => {
    const moves = state === State.awake || state === State.asleep;
    if (moves && colouring() === "island" && island >= 0) islandColor(island, out);
    else if (moves && colouring() === "activity") out.copy(state === State.asleep ? ASLEEP : AWAKE);
    else paintBody(row, state, out);
    if (state === State.asleep && sleepShown()) out.lerp(ASLEEP, 0.5);
    if (row === chosen()) out.lerp(SELECTED, 0.55);
  };
}

/** From a nanometre (yellow) to a metre (red), by the logarithm. */
export function differenceColor(metres: number, out: three.Color): three.Color {
  const size = Math.min(Math.max((Math.log10(Math.max(metres, 1e-9)) + 9) / 9, 0), 1);
  return out.setHSL(0.16 - 0.16 * size, 0.95, 0.56 - 0.08 * size);
}

/** `rows` has the comparison of both worlds. */
export function differencePainter(rows: () => Float32Array, chosen: () => number): Painter {
  return (row, state, _, out) => {
    const [flags = 0, metres = 0] = [rows()[4 * row], rows()[4 * row + 1]];
    if (state === State.fixed && flags === 0) out.copy(FIXED);
    else if (flags === 0) out.copy(SAME);
    else differenceColor(metres, out);
    if (row === chosen()) out.lerp(SELECTED, 0.55);
  };
}
