// The page: the player of one seat of a match of the arena. ?seat=N&name=NAME; /seat/N says where and with which token.
import { Client, View, loadSession } from "lockstone/session";
import { Picture } from "../testbed/picture.mjs";

const KEYS = { KeyW: "up", ArrowUp: "up", KeyS: "down", ArrowDown: "down", KeyA: "left", ArrowLeft: "left", KeyD: "right", ArrowRight: "right" };
const SEATS = 64, SERVER = 253, CHAT = 1;  // tools/arena/arena_command.h
const BUTTONS = { Space: 1, KeyE: 2, KeyF: 4, KeyX: 8 };
const seat = new URLSearchParams(location.search).get("seat") ?? "0";
const { url, token } = await (await fetch(`/seat/${seat}`)).json();
const lockstone = await loadSession();
const name = new URLSearchParams(location.search).get("name") ?? `tab ${seat}`;
const client = new Client(lockstone, { url, token, name, predictionTicks: 8 });
const canvas = document.getElementById("picture");
const picture = new Picture(canvas);
const held = new Set();
let view, yaw = 0, desync = "";
Object.assign(window, { client, picture });

/** Eight bytes: two axes, where to aim, buttons (tools/arena/input.h). */
function input() {
  const axis = (plus, minus) => Number(held.has(plus)) - Number(held.has(minus));
  const ahead = axis("up", "down"), aside = axis("right", "left");
  const sin = Math.sin(picture.turn), cos = Math.cos(picture.turn);
  const x = -sin * ahead + cos * aside, z = -cos * ahead - sin * aside;
  const length = Math.hypot(x, z) || 1;
  if (x !== 0 || z !== 0) yaw = Math.round(Math.atan2(z, x) / (2 * Math.PI) * 65536);
  const bytes = new DataView(new ArrayBuffer(8));
  bytes.setInt8(0, Math.round(127 * x / length));
  bytes.setInt8(1, Math.round(127 * z / length));
  bytes.setInt16(2, yaw, true);
  bytes.setUint8(4, Object.entries(BUTTONS).reduce((set, [key, bit]) => set | (held.has(key) ? bit : 0), 0));
  return new Uint8Array(bytes.buffer);
}

function press(event, down) {
  if (event.target.tagName === "INPUT") return;
  const name = KEYS[event.code] ?? (event.code in BUTTONS ? event.code : null);
  if (name === null) return;
  down ? held.add(name) : held.delete(name);
  event.preventDefault();
}
addEventListener("keydown", (event) => press(event, true));
addEventListener("keyup", (event) => press(event, false));
addEventListener("blur", () => held.clear());
canvas.onpointermove = (event) => {
  if (event.buttons === 0) return;
  picture.turn -= event.movementX / 200;
  picture.rise = Math.min(Math.max(picture.rise + event.movementY / 200, 0.05), 1.5);
};
canvas.onwheel = (event) => (picture.distance *= Math.exp(event.deltaY / 1000));

function tell(slot, text) {
  const who = slot === SERVER ? "server" : client.playerName(slot) || `player ${slot}`;
  document.getElementById("chat").append(Object.assign(document.createElement("div"), { textContent: `${who}: ${text}` }));
}
document.getElementById("say").onsubmit = (event) => {
  event.preventDefault();
  const line = event.target.elements.line;
  if (line.value !== "" && client.state === "running") client.sendCommand(new Uint8Array([CHAT, ...new TextEncoder().encode(line.value)]));
  line.value = "";
  canvas.focus();
};

function update() {
  client.setInput(input());
  for (const event of client.update()) {
    if (event.kind === "desync") desync = event.text;
    if (event.kind === "command" && event.bytes[0] === CHAT) tell(event.slot, new TextDecoder().decode(event.bytes.subarray(1)));
  }
  const { stats } = client;
  document.getElementById("players").textContent = Array.from({ length: SEATS }, (_, slot) => slot)
    .filter((slot) => client.playerName(slot) !== "").map((slot) => `${slot} ${client.playerName(slot)}`).join(" · ");
  document.getElementById("state").textContent = `player ${client.slot}, ${client.state}, tick ${client.ticks}` +
    `, margin ${stats.marginQuarters / 4} ticks, ${stats.rollbacks} rollbacks${desync && `\n${desync}`}${client.reason && `\n${client.reason}`}`;
}
setInterval(update, 4);

/** The player of this tab: a tag names its kind, 1, and its slot (tools/arena/tags.h). */
function follow() {
  const own = [...client.world.bodies()].find((body) => Number(body.view.userData & 0xffffffn) === 1 + 256 * client.slot);
  if (own) [picture.sun.target.position.x, , picture.sun.target.position.z] = own.position;
}

function frame() {
  const { world } = client;
  if (world !== null && client.ticks > 0) {
    if (!view) {
      view = new View(world);
      view.reset();
      picture.show(view);
      Object.assign(picture, { distance: 0.5, rise: 0.6 });
    }
    view.reset();
    follow();
    picture.draw(view, 1);
  }
  requestAnimationFrame(frame);
}
frame();
