// The timeline of a log: proof, figures, keyframes, events, and a lane of inputs for each player.
import { make } from "./dom.js";
import { type LogFile, Origin } from "./log_file.js";
import { Proof, type Proofs } from "./log_stage.js";

const PROOF_HEIGHT = 10, CURVE_HEIGHT = 34, LANE_HEIGHT = 11, MARKS_HEIGHT = 10;

/** What a player did in a tick. */
const Deed = { absent: 0, still: 1, active: 2, late: 3 } as const;

/** By player and tick: absent, the input of the tick before, another one, or none in time. */
export function deedsOf(log: LogFile): Uint8Array[] {
  return Array.from({ length: log.players }, (_, slot) => {
    const deeds = new Uint8Array(log.ticks);
    for (let i = 0; i < log.ticks; ++i) {
      const origin = log.origins[i * log.players + slot];
      deeds[i] = origin === Origin.absent ? Deed.absent : origin !== Origin.received ? Deed.late : changed(log, i, slot) ? Deed.active : Deed.still;
    }
    return deeds;
  });
}

// The last two bytes of the arena's inputs count them, and change always.
function changed(log: LogFile, index: number, slot: number): boolean {
  if (index === 0) return false;
  const bytes = log.isArena ? 6 : log.inputBytes;
  const at = (index * log.players + slot) * log.inputBytes, before = at - log.players * log.inputBytes;
  for (let i = 0; i < bytes; ++i) if (log.inputs[at + i] !== log.inputs[before + i]) return true;
  return false;
}

export class LogLane {
  readonly canvas = make("canvas", { id: "timeline" });
  private readonly deeds: Uint8Array[];
  private readonly still = make("canvas"); // everything but the proof and the position
  private stillKey = "";

  constructor(private readonly log: LogFile, private readonly proofs: Proofs, private readonly figures: Float32Array, seek: (tick: number, moving: boolean) => void) {
    this.deeds = deedsOf(log);
    this.canvas.style.height = `${this.height}px`;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Timeline: proof, energy, keyframes and events, inputs of each player");
    const go = ({ offsetX }: PointerEvent, moving: boolean) => seek(log.startTick + Math.round((offsetX / this.canvas.clientWidth) * log.ticks), moving);
    this.canvas.onpointerdown = (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      go(event, true);
    };
    this.canvas.onpointermove = (event) => event.buttons & 1 && go(event, true);
    this.canvas.onpointerup = (event) => go(event, false);
  }

  get height(): number {
    return PROOF_HEIGHT + CURVE_HEIGHT + MARKS_HEIGHT + LANE_HEIGHT * this.log.players;
  }

  /** `known`: how many ticks have figures. */
  draw(tick: number, known: number): void {
    const width = this.canvas.clientWidth, { height } = this;
    if (width === 0) return;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    const style = getComputedStyle(this.canvas);
    const key = [width, known, style.getPropertyValue("--accent")].join();
    if (key !== this.stillKey) this.drawStill(width, known, style);
    this.stillKey = key;
    const pen = this.canvas.getContext("2d")!;
    pen.clearRect(0, 0, width, height);
    pen.drawImage(this.still, 0, 0);
    this.drawProof(pen, width, style);
    pen.fillStyle = style.getPropertyValue("--text");
    pen.fillRect(((tick - this.log.startTick) / this.log.ticks) * (width - 2), 0, 2, height);
  }

  private drawProof(pen: CanvasRenderingContext2D, width: number, style: CSSStyleDeclaration): void {
    const { log, proofs } = this;
    const colors = ["--idle", "--good", "--bad"]; // by verdict
    for (let x = 0; x < width; ++x) {
      const [from, to] = [Math.floor((x / width) * log.ticks), Math.max(Math.ceil(((x + 1) / width) * log.ticks), 1)];
      let verdict: number = Proof.same;
      for (let i = from; i < Math.min(to, log.ticks); ++i) {
        const one = proofs.verdicts[i]!;
        if (one === Proof.different) verdict = one;
        else if (one === Proof.unknown && verdict === Proof.same) verdict = one;
      }
      pen.fillStyle = style.getPropertyValue(colors[verdict]!);
      pen.fillRect(x, 0, 1, PROOF_HEIGHT - 2);
    }
  }

  private drawStill(width: number, known: number, style: CSSStyleDeclaration): void {
    Object.assign(this.still, { width, height: this.height });
    const pen = this.still.getContext("2d")!;
    this.drawCurve(pen, width, known, style.getPropertyValue("--accent"));
    this.drawMarks(pen, width, style);
    this.deeds.forEach((deeds, slot) => this.drawLane(pen, width, deeds, slot, style));
  }

  // The energy, from its least to its greatest value.
  private drawCurve(pen: CanvasRenderingContext2D, width: number, known: number, color: string): void {
    let low = Infinity, high = -Infinity;
    const energy = (i: number) => this.figures[3 * i]!;
    for (let i = 0; i < known; ++i) [low, high] = [Math.min(low, energy(i)), Math.max(high, energy(i))];
    pen.strokeStyle = color;
    pen.beginPath();
    for (let x = 0; x < width; ++x) {
      const i = Math.floor((x / width) * this.log.ticks);
      if (i >= known) break;
      const y = PROOF_HEIGHT + CURVE_HEIGHT - 3 - ((energy(i) - low) / Math.max(high - low, 1e-9)) * (CURVE_HEIGHT - 6);
      x === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y);
    }
    pen.stroke();
  }

  private drawMarks(pen: CanvasRenderingContext2D, width: number, style: CSSStyleDeclaration): void {
    const { log } = this, top = PROOF_HEIGHT + CURVE_HEIGHT;
    const x = (tick: number) => ((tick - log.startTick) / log.ticks) * (width - 2);
    pen.fillStyle = style.getPropertyValue("--quiet");
    for (const tick of log.keyframes) pen.fillRect(x(tick), top, 1.5, MARKS_HEIGHT - 3);
    pen.fillStyle = style.getPropertyValue("--accent");
    for (const { tick } of log.events) {
      pen.beginPath();
      pen.arc(x(tick) + 1, top + 3, 3, 0, 7);
      pen.fill();
    }
  }

  // The strongest deed of the ticks behind each pixel.
  private drawLane(pen: CanvasRenderingContext2D, width: number, deeds: Uint8Array, slot: number, style: CSSStyleDeclaration): void {
    const top = PROOF_HEIGHT + CURVE_HEIGHT + MARKS_HEIGHT + LANE_HEIGHT * slot;
    const colors = ["transparent", "--idle", "--accent", "--late"].map((name) => (name.startsWith("--") ? style.getPropertyValue(name) : name));
    for (let x = 0; x < width; ++x) {
      const to = Math.max(Math.ceil(((x + 1) / width) * deeds.length), 1);
      let deed = 0;
      for (let i = Math.floor((x / width) * deeds.length); i < Math.min(to, deeds.length); ++i) deed = Math.max(deed, deeds[i]!);
      pen.fillStyle = colors[deed]!;
      pen.fillRect(x, top, 1, LANE_HEIGHT - 2);
    }
  }
}
