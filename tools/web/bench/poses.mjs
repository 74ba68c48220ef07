// The time that a frame takes to get the poses of many bodies.
import { engines } from "./engines.mjs";

export const bodies = 10000;

function median(times) {
  return times.sort((a, b) => a - b)[times.length >> 1];
}

/** Milliseconds of each way to get the poses. */
export async function posesTime(frames = 200) {
  const { module, loaded } = await engines.simd.load();
  const world = new module.World(loaded, { bodyCapacity: bodies, gravity: [0, 0, 0], sleepMs: 0 });
  for (let i = 0; i < bodies; ++i) {
    world.createBody({
      shape: module.box(0.25, 0.25, 0.25), position: [2 * (i % 100), 0, 2 * Math.floor(i / 100)],
      velocity: [0, 1, 0], angularVelocity: [0, 1, 0],
    });
  }
  const view = new module.View(world);
  world.step();
  const timed = (use) => median(Array.from({ length: frames }, () => {
    const before = performance.now();
    use();
    return performance.now() - before;
  }));
  return { raw: timed(() => world.poses()), update: timed(() => view.update()), at: timed(() => view.at(0.5)) };
}
