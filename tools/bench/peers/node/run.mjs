// Plays neutral scenes by an engine of the npm registry and prints a line of JSON for each.
//
// usage: node run.mjs ENGINE SCENES.json REPEATS SETTING…
//
// SCENES.json is what `lockstone bench scenes --json` prints. Exit code 3: the engine is absent.
import { readFileSync, writeSync } from "node:fs";

const ABSENT = 3;
const ENOUGH = 0.5; // seconds of one point: not repeated any more
const [engine_name, scenes_file, repeats, ...settings] = process.argv.slice(2);

async function load(name) {
  try {
    return await (await import(`./${name}.mjs`)).load();
  } catch (error) {
    if (error.code !== "ERR_MODULE_NOT_FOUND") throw error;
    console.error(`${name} is absent: ${error.message}`);
    process.exit(ABSENT);
  }
}

function gravityAt(scene, time) {
  const tilt = scene.tilt;
  let degrees = tilt.length ? tilt[tilt.length - 1].degrees : 0;
  const after = tilt.findIndex((t) => t.time > time);
  if (after === 0) degrees = tilt[0].degrees;
  if (after > 0) {
    const from = tilt[after - 1], to = tilt[after];
    degrees = from.degrees + ((to.degrees - from.degrees) * (time - from.time)) / (to.time - from.time);
  }
  const angle = (degrees * Math.PI) / 180;
  return [scene.gravity * Math.sin(angle), -scene.gravity * Math.cos(angle), 0];
}

export function massOf(body) {
  const [x, y, z] = body.size;
  return body.density * (body.shape === "box" ? 8 * x * y * z : ((4 * Math.PI) / 3) * x * x * x);
}

function drive(world, scene, tick, rate) {
  if (scene.tilt.length > 1) world.setGravity(gravityAt(scene, (tick + 1) / rate));
  for (const kick of scene.kicks)
    if (Math.round(kick.time * rate) === tick) world.setVelocity(kick.body, kick.velocity);
}

// Calls `look` every so many ticks.
function play(engine, scene, setting, rate, look) {
  const world = engine.make(scene, setting, gravityAt(scene, 0));
  const ticks = Math.round(scene.seconds * rate);
  const begin = process.cpuUsage();
  for (let tick = 0; tick < ticks; ++tick) {
    drive(world, scene, tick, rate);
    world.step();
    if (look && (tick + 1) % scene.record_every === 0) look(world);
  }
  const used = process.cpuUsage(begin);
  world.free();
  return (used.user + used.system) * 1e-6 / scene.seconds;
}

// A whole line, though a pipe takes only part of it at a time.
function print(line) {
  const bytes = Buffer.from(line + "\n");
  for (let at = 0; at < bytes.length; ) {
    try {
      at += writeSync(1, bytes, at);
    } catch (error) {
      if (error.code !== "EAGAIN") throw error;
    }
  }
}

const engine = await load(engine_name);
const file = JSON.parse(readFileSync(scenes_file, "utf8"));
for (const scene of file.scenes) {
  for (const setting of settings.map(Number)) {
    const samples = [], cpu_seconds = [];
    const first = play(engine, scene, setting, file.tick_rate,
                       (world) => samples.push(scene.watched.map((body) => world.state(body))));
    let taken = first * scene.seconds;
    // A long run is its own first repeat.
    if (taken > ENOUGH) cpu_seconds.push(first);
    else taken = 0;
    for (let i = 0; i < Number(repeats) && taken < ENOUGH; ++i) {
      cpu_seconds.push(play(engine, scene, setting, file.tick_rate));
      taken += cpu_seconds[i] * scene.seconds;
    }
    print(JSON.stringify({ engine: engine.name, scene: scene.name, setting, cpu_seconds, note: engine.version, samples }));
  }
}
