// The page: plays a built-in scene, pauses, steps, goes back; shows tick and hash. Drag to turn, scroll to
// come nearer. #scene in the address names the first scene.
import { loadFull, sceneNames } from "lockstone/full";
import { Picture } from "./picture.mjs";
import { Player } from "./player.mjs";

const element = (id) => document.getElementById(id);
const canvas = element("picture");
const picture = new Picture(canvas);
const lockstone = await loadFull();
let player, playing = true, due = 0, last = performance.now();

function begin(name) {
  player?.destroy();
  player = new Player(lockstone, name);
  picture.show(player.view);
  due = 0;
  location.hash = name;
}

function pause(wanted) {
  playing = !wanted;
  due = 0;
  element("play").textContent = wanted ? "Play" : "Pause";
}

function tell() {
  const { world, tick, first } = player;
  Object.assign(element("tick"), { min: first, max: player.last, value: tick });
  element("state").textContent = `tick ${tick}  hash ${world.hash}`;
}

function play(seconds) {
  const { tickRate } = player.world;
  due = Math.min(due + seconds * tickRate, 4);
  for (; due >= 1; --due) player.step();
}

function frame(now) {
  if (playing) play((now - last) / 1000);
  last = now;
  picture.draw(player.view, playing ? due : 1);
  tell();
  requestAnimationFrame(frame);
}

function seek(tick) {
  pause(true);
  player.seek(tick);
}

element("scene").append(...sceneNames(lockstone).map((name) => new Option(name)));
element("scene").value = decodeURIComponent(location.hash.slice(1)) || "wall";
element("scene").onchange = () => begin(element("scene").value);
element("restart").onclick = () => begin(element("scene").value);
element("play").onclick = () => pause(playing);
element("back").onclick = () => seek(player.tick - 1);
element("step").onclick = () => {
  pause(true);
  player.step();
};
element("tick").oninput = ({ target }) => seek(Number(target.value));
canvas.onpointermove = ({ buttons, movementX, movementY }) => {
  if (!buttons) return;
  picture.turn -= movementX * 0.005;
  picture.rise = Math.min(Math.max(picture.rise + movementY * 0.005, -0.2), 1.5);
};
canvas.onwheel = ({ deltaY }) => (picture.distance *= Math.exp(deltaY * 0.001));

begin(element("scene").value);
requestAnimationFrame(frame);
