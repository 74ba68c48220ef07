// Plays built-in scenes, in Node and in browsers, and compares their hashes with those on record.

/** The names of the scenes whose hashes differ from those of `golden` (tests/golden/scenes.json). */
export function differingScenes({ createScene }, lockstone, golden) {
  return Object.keys(golden).filter((name) => {
    const chain = play(createScene(lockstone, name), golden[name].ticks);
    return chain.join() !== golden[name].chain.join();
  });
}

/** The hashes of every tenth tick and of the last. */
function play(world, ticks) {
  const chain = [];
  for (let tick = 1; tick <= ticks; ++tick) {
    world.step();
    if (tick % 10 === 0 || tick === ticks) chain.push(world.hash);
  }
  world.destroy();
  return chain;
}

/** Eight short scenes: enough for a binding. */
export function someOf(golden) {
  const order = ([a, { ticks: m }], [b, { ticks: n }]) => m - n || (a < b ? -1 : 1);
  return Object.fromEntries(Object.entries(golden).sort(order).slice(0, 8));
}
