// The page: loads the module, opens a view, and draws it.
import { Engine } from "./engine.js";
import { byId, make, saveFile } from "./dom.js";
import { Clip } from "./clip.js";
import { cryptoImports } from "../../web/src/crypto.js";
import { DesyncView } from "./desync.js";
import { Hand } from "./hand.js";
import { LiveView } from "./live.js";
import { LogView } from "./log.js";
import { seenOf } from "./link.js";
import type { Mode } from "./mode.js";
import { Picture } from "./picture.js";
import { Sequence } from "./sequence.js";
import { type Session, bytesOf, sessionOf } from "./session.js";
import { Testbed } from "./testbed.js";
import { Transport } from "./transport.js";
import { WorldView } from "./world_view.js";

const KEYS: [string, string][] = [
  ["space", "play or pause"], ["← →", "one tick back or on"], ["shift ← →", "60 ticks"], ["R", "back by 600 ticks"], ["Home", "to the beginning"],
  ["1 … 6", "testbed: contacts, joints, bounds, centres of mass, sleeping, triggers"], ["C", "testbed: colour by body, island, activity"],
  ["F B U X", "testbed: throw, drop, push up, remove"], ["N", "log, desync: to the first difference"], ["O", "desync: both worlds in one picture"],
  ["P", "save a picture"], ["V", "begin a film, end and save it"], ["I", "begin a picture of every tick, end and save them"], ["L", "copy a link"], ["T", "light or dark"],
];
const VIEWS = { testbed: "Testbed", log: "Log", desync: "Desync", live: "Live", world: "World" } as const;
type ViewName = keyof typeof VIEWS;

// Events after which the picture may be another one.
const STIRRING = ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "input", "change", "click", "resize"];
const SETTLE_MS = 150; // between a frame drawn after one and the next, which shows the changes that the first one's figures made
const IDLE_MS = 500; // between frames later on

let mode: Mode | null = null;
let stirred = true;
let dueAt = 0; // of the next frame if nothing stirs
const picture = new Picture(byId<HTMLCanvasElement>("picture"));
const transport = new Transport(() => mode);
new Hand(picture, () => mode);
const clip = new Clip(picture.canvas, byId("clip"), () => mode?.lead.tick ?? 0);
const sequence = new Sequence(picture.canvas, byId("sequence"));

function tell(text: string): void {
  byId("message").hidden = text === "";
  byId("message").textContent = text;
}

function setTheme(dark: boolean): void {
  document.documentElement.dataset["theme"] = dark ? "dark" : "light";
  picture.setTheme();
}

function toggleTheme(): void {
  setTheme(document.documentElement.dataset["theme"] !== "dark");
}

async function shareLink(): Promise<void> {
  const fragment = mode?.link?.();
  if (!fragment) return;
  history.replaceState(null, "", fragment);
  await navigator.clipboard?.writeText(location.href).catch(() => undefined); // the address bar has it too
}

function savePicture(): void {
  const { tick } = mode?.lead ?? { tick: 0 };
  picture.canvas.toBlob((blob) => blob && saveFile(`lockstone-tick-${tick}.png`, blob), "image/png");
}

function press(event: KeyboardEvent): boolean {
  const { target, key, shiftKey } = event;
  const typing = target instanceof HTMLInputElement && target.type !== "checkbox" && target.type !== "range";
  if (typing || target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey) return false;
  const deeds: Record<string, () => void> = {
    " ": () => transport.play(!transport.playing), ArrowRight: () => (shiftKey ? transport.move(60) : transport.stepOnce()),
    ArrowLeft: () => transport.move(shiftKey ? -60 : -1), Home: () => transport.seek(0), r: () => transport.move(-600),
    p: savePicture, v: () => clip.toggle(), i: () => sequence.toggle(), l: () => void shareLink(), t: toggleTheme, "?": () => byId<HTMLDialogElement>("keys").showModal(),
  };
  const deed = deeds[key.length === 1 ? key.toLowerCase() : key];
  if (deed) deed();
  return deed !== undefined || (mode?.key?.(key.toLowerCase()) ?? false);
}

async function open(engine: Engine, session: Session, view: ViewName): Promise<void> {
  mode?.destroy();
  mode = null;
  transport.play(false);
  if (view === "testbed") {
    const seen = seenOf(location.hash) ?? { scene: "wall", seed: 1n, values: {}, tick: 0, camera: [], overlays: [], colour: "body", journal: new Map() };
    mode = new Testbed(engine, picture, (on) => on !== transport.playing && transport.play(on), seen);
    transport.play(seen.tick === 0);
  } else if (view === "log") {
    mode = new LogView(engine, picture, await bytesOf("log/0"), (tick) => transport.seek(tick));
  } else if (view === "live") {
    mode = await LiveView.open(engine, picture, session.live!);
  } else if (view === "world") {
    mode = await WorldView.open(engine, picture, session.world!);
  } else {
    mode = await DesyncView.open(engine, picture, session, (tick) => transport.seek(tick));
  }
  byId("panel").replaceChildren(...mode.panel.children);
  byId("lane").replaceChildren(...(mode.lane ? [mode.lane] : []));
  byId("labels").replaceChildren(...mode.labels.map((text) => make("span", {}, text)));
  for (const tab of byId("views").children) tab.toggleAttribute("aria-current", false);
  byId(`view-${view}`).setAttribute("aria-current", "page");
  byId("share").hidden = !mode.link;
  byId("transport").hidden = mode.fraction !== undefined;
}

async function openSafely(engine: Engine, session: Session, view: ViewName): Promise<void> {
  tell("Opening …");
  try {
    await open(engine, session, view);
    stirred = true;
    tell("");
  } catch (error) {
    tell(error instanceof Error ? error.message : String(error));
  }
}

function takeFiles(): void {
  const scene = byId("scene");
  scene.ondragover = (event) => mode?.openFile && event.preventDefault();
  scene.ondrop = (event) => {
    const file = event.dataTransfer?.files[0];
    if (!file || !mode?.openFile) return;
    event.preventDefault();
    void mode.openFile(file);
  };
}

function frame(now: number): void {
  requestAnimationFrame(frame);
  if (!sequence.runs) transport.advance(now);
  else if (sequence.ready) transport.advanceOnce();
  if (!mode) return;
  const { fraction, goal } = mode;
  const moves = Boolean(goal) || transport.playing;
  const wanted = stirred || moves || fraction !== undefined || clip.runs || sequence.runs;
  if (!wanted && now < dueAt) return;
  dueAt = now + (wanted ? SETTLE_MS : IDLE_MS);
  stirred = moves; // the tick that it stops at is drawn too
  const pulled = mode instanceof Testbed ? mode.pulled : null;
  picture.draw(mode.dioramas, fraction ?? (sequence.runs ? 1 : transport.fraction), mode.shown, pulled, (moves || fraction !== undefined) && !clip.runs && !sequence.runs);
  sequence.take(mode.lead.tick);
  mode.refresh(picture.wantsFigures);
  transport.refresh();
  byId("tick-text").textContent = `tick ${mode.lead.tick}${mode.goal ? ` … ${mode.goal}` : ""}`;
  byId("hash-text").textContent = mode.lead.hash;
}

async function begin(): Promise<void> {
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
  byId("theme").onclick = toggleTheme;
  byId("share").onclick = () => void shareLink();
  byId("shoot").onclick = savePicture;
  byId("keys").append(make("h2", {}, "Keys"), ...KEYS.map(([key, text]) => make("p", {}, make("kbd", {}, key), ` ${text}`)));
  byId("help").onclick = () => byId<HTMLDialogElement>("keys").showModal();
  for (const name of STIRRING) addEventListener(name, () => (stirred = true), { capture: true, passive: true });
  document.addEventListener("keydown", (event) => press(event) && event.preventDefault());
  takeFiles();
  tell("Loading …");
  const module = WebAssembly.compileStreaming(fetch(new URL("lockstone-studio.wasm", document.baseURI)));
  const [session, engine] = await Promise.all([sessionOf(), module.then((one) => Engine.load(one, cryptoImports))]);
  const views = (Object.keys(VIEWS) as ViewName[]).filter((view) => view === "testbed" || session.views.includes(view));
  for (const view of views) {
    const tab = make("button", { type: "button", id: `view-${view}`, onclick: () => void openSafely(engine, session, view) }, VIEWS[view]);
    byId("views").append(tab);
  }
  requestAnimationFrame(frame);
  addEventListener("hashchange", () => seenOf(location.hash) && void openSafely(engine, session, "testbed"));
  await openSafely(engine, session, seenOf(location.hash) ? "testbed" : views.at(-1)!);
}

begin().catch((error: unknown) => tell(String(error)));
