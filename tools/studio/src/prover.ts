// A worker that computes a whole log again, in the background of the page that shows it.
import { LKS_CANONICAL } from "../../web/src/declarations.js";
import { Engine } from "./engine.js";
import { States } from "./history.js";
import { LogFile } from "./log_file.js";

/** Figures of each tick, in this order. */
export const SERIES = ["energy", "contacts", "awake"] as const;

export interface ProverTask {
  module: WebAssembly.Module;
  log: Uint8Array;
  /** Ticks between the states that are sent. */
  every: number;
}

export interface ProverNews {
  /** The ticks `from` … `from + same.length - 1`. */
  from: number;
  same: Uint8Array;
  /** Numbers of SERIES, tick by tick. */
  figures: Float32Array;
  /** The state after them. */
  state: Uint8Array;
  done: boolean;
}

async function prove({ module, log: bytes, every }: ProverTask): Promise<void> {
  const engine = await Engine.load(module);
  const log = new LogFile(engine, bytes);
  const world = log.makeWorld();
  const states = new States(world, LKS_CANONICAL);
  for (let tick = log.startTick; tick < log.endTick;) {
    const from = tick, until = Math.min(log.endTick, tick - (tick % every) + every);
    const same = new Uint8Array(until - from);
    const figures = new Float32Array(SERIES.length * same.length);
    for (; tick < until; ++tick) {
      same[tick - from] = log.step(world) ? 1 : 0;
      const { kinetic, potential, contacts, awake } = engine.measure(world);
      figures.set([kinetic + potential, contacts, awake], SERIES.length * (tick - from));
    }
    const state = states.save();
    const news: ProverNews = { from, same, figures, state, done: tick === log.endTick };
    postMessage(news, { transfer: [same.buffer, figures.buffer, state.buffer] });
  }
}

onmessage = ({ data }: MessageEvent<ProverTask>) => void prove(data);
