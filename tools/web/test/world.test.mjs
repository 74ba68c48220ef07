import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

import { ballAbove, folder, full, root } from "./support.mjs";

const lockstone = await full.load();
const whole = await full.loadFull();
const c = await import(pathToFileURL(`${folder}/dist/declarations.js`));
const { EventKind, JointKind, Motion } = full;

test("the core has no scenes, the full file has them", () => {
  assert.equal(lockstone.heap.f.lks_world_create_scene, undefined);
  assert.throws(() => full.createScene(whole, "no such scene"), { status: full.Status.notFound });
  const scene = full.createScene(whole, "stack");
  assert.throws(() => scene.bodies()[0].destroy(), { status: full.Status.readOnly });
});

test("a ball falls to the floor and ends in the state that the other bindings print", () => {
  const { world, ball } = ballAbove(lockstone);
  world.step(120);
  assert.equal(world.tick, 120);
  assert.equal(Math.round(ball.position[1] * 1000), 250);
  assert.equal(world.hash, "5bc0d10ce0d2c91d");
});

test("vectors change no result", async () => {
  const hashes = [];
  for (const simd of [true, false]) {
    const { world } = ballAbove(await full.load({ simd }));
    world.step(60);
    hashes.push(world.hash);
  }
  assert.equal(hashes[0], hashes[1]);
});

test("the module is loaded from bytes, a compiled module, and a response", async () => {
  const bytes = readFileSync(`${folder}/dist/lockstone.wasm`);
  const type = { headers: { "content-type": "application/wasm" } };
  for (const wasm of [bytes, await WebAssembly.compile(bytes), new Response(bytes), new Response(bytes, type)]) {
    assert.equal((await full.load({ wasm, simd: false })).canaryHash, lockstone.canaryHash);
  }
});

test("a refused call says why and changes nothing", () => {
  const { world, ball } = ballAbove(lockstone);
  const before = world.hash;
  assert.throws(() => world.createBody({ shape: full.sphere(0) }),
    (error) => error instanceof full.LockstoneError && error.status === full.Status.invalidArgument &&
      error.reason.includes("radius"));
  assert.equal(world.hash, before);
  ball.destroy();
  assert.equal(ball.exists, false);
  assert.throws(() => ball.setVelocity([1, 0, 0]), { statusName: "stale handle" });
});

test("commands reach the body", () => {
  const { world, ball } = ballAbove(lockstone, { gravity: [0, 0, 0] });
  ball.setVelocity([1, 2, 3]);
  ball.setAngularVelocity([0, 1, 0]);
  assert.deepEqual(ball.velocity, [1, 2, 3]);
  ball.teleport([5, "20.5", -3n], [0, 1, 0, 0]);
  assert.deepEqual(ball.position, [5, 20.5, -3 / 2 ** 32]);
  assert.deepEqual(ball.orientation, [0, 1, 0, 0]);
  ball.applyImpulse([ball.view.mass, 0, 0]);
  assert.ok(Math.abs(ball.velocity[0] - 2) < 1e-6);
  for (const order of [
    () => ball.applyImpulse([1, 0, 0], [0, 0.1, 0], true), () => ball.applyAngularImpulse([0, 1, 0]),
    () => ball.applyForce([0, 5, 0]), () => ball.applyForce([0, 5, 0], [0.1, 0, 0]), () => ball.applyTorque([1, 0, 0]),
    () => ball.setSurface({ friction: 0.25, restitution: 0.5, tag: 7 }), () => ball.setGravityScale(2),
    () => ball.setDamping(0.1, 0.2), () => ball.setLocks(full.Lock.turnX), () => ball.setSpeedLimit(100, 50),
    () => ball.setFilter({ category: 2, mask: 3, group: -1 }), () => ball.setEvents(false, 2),
    () => ball.setUserData(99n), () => ball.setName("ball"), () => ball.sleep(), () => ball.wake(),
    () => ball.setAllowSleep(false), () => world.setGravity([0, -5, 0]),
  ]) {
    const before = world.hash;
    order();
    world.step();
    assert.notEqual(world.hash, before);
  }
  const { friction, restitution, tag, userData, locks, motion } = ball.view;
  assert.deepEqual({ friction, restitution, tag, userData, locks, motion },
    { friction: 0.25, restitution: 0.5, tag: 7, userData: 99n, locks: full.Lock.turnX, motion: Motion.dynamic });
});

test("kinematic bodies and belts move other bodies", () => {
  const { world, ball } = ballAbove(lockstone);
  const belt = world.createBody({
    shape: full.box(5, 0.5, 5), motion: Motion.kinematic, position: [0, 1, 0], surfaceMotion: { velocity: [2, 0, 0] },
  });
  belt.moveKinematic([0, 1.05, 0]);
  world.step(150);
  assert.ok(ball.velocity[0] > 0.4);
  assert.ok(belt.position[1] > 1.04);
  belt.setVelocity([0, 0, 0]);
  belt.setSurfaceMotion({ velocity: [-2, 0, 0] });
  world.step(100);
  assert.ok(ball.velocity[0] < 0.1);
});

test("events name the bodies", () => {
  const { world, ball } = ballAbove(lockstone);
  ball.setEvents(true, 1);
  let begun = null, hit = null;
  for (let i = 0; i < 120; ++i) {
    world.step();
    begun ??= full.events(world).find(({ kind }) => kind === EventKind.contactBegin) ?? null;
    hit ??= full.hitEvents(world)[0] ?? null;
  }
  assert.ok(begun !== null && (begun.a.equals(ball) || begun.b?.equals(ball)));
  assert.ok(begun.approachSpeed > 10);
  assert.ok(hit !== null && hit.normalImpulse > 0 && Math.abs(hit.point[1]) < 0.01);
  const [contact] = full.contactsOf(ball);
  assert.ok(full.touching(ball, contact.other));
  assert.ok(Math.abs(contact.normalForce - ball.view.mass * 9.81) < 1);
  assert.equal(contact.points.length, 1);
});

test("queries see the bodies", () => {
  const { world, ball } = ballAbove(lockstone);
  const hit = full.castRay(world, [0, 20, 0], [0, -30, 0]);
  assert.ok(hit?.body.equals(ball));
  assert.ok(Math.abs(hit.point[1] - 10.25) < 1e-6);
  assert.deepEqual(hit.normal.map(Math.round), [0, 1, 0]);
  assert.equal(full.castRayAll(world, [0, 20, 0], [0, -30, 0]).length, 2);
  assert.ok(!full.castRay(world, [0, 20, 0], [0, -30, 0], { ignore: ball })?.body.equals(ball));
  assert.ok(!full.castRay(world, [0, 20, 0], [0, -30, 0], { bodies: [ball] })?.body.equals(ball));
  assert.ok(full.castRay(world, [0, 20, 0], [0, -30, 0], { bodies: [ball], onlyListed: true })?.body.equals(ball));
  assert.equal(full.castRay(world, [0, 20, 0], [0, -30, 0], { bodies: [ball], onlyListed: true, tagMask: 1, tag: 1 }), null);
  assert.equal(full.castRay(world, [9, 20, 0], [0, 5, 0]), null);
  assert.equal(full.isRayBlocked(world, [0, 20, 0], [0, -5, 0]), false);
  assert.ok(full.castShape(world, full.box(1, 1, 1), [0, 20, 0], [0, -30, 0])?.body.equals(ball));
  assert.deepEqual(full.overlapSphere(world, [0, 10, 0], 1).map(({ id }) => id), [ball.id]);
  assert.deepEqual(full.overlapShape(world, full.box(1, 1, 1), [0, 10, 0]).map(({ id }) => id), [ball.id]);
  assert.deepEqual(full.bodiesInBox(world, [-1, 9, -1], [1, 9.7499, 1]).map(({ id }) => id), []);
  assert.deepEqual(full.bodiesInBox(world, [-1, 9, -1], [1, 9.7501, 1]).map(({ id }) => id), [ball.id]);
  assert.deepEqual(full.bodiesInBox(world, [-1, 9, -1], [1, 11, 1], { ignore: ball }), []);
  assert.throws(() => full.bodiesInBox(world, [0, 1, 0], [1, 0, 1]), /lower: must not be above/);
  const closest = full.closestPoint(world, [0, 11, 0], 5);
  assert.ok(closest?.body.equals(ball) && Math.abs(closest.distance - 0.75) < 1e-4);
});

test("more results than fit at first are all returned", () => {
  const world = new full.World(lockstone, { bodyCapacity: 512, gravity: [0, 0, 0] });
  for (let i = 0; i < 300; ++i) world.createBody({ shape: full.sphere(0.3), position: [i, 0, 0] });
  assert.equal(full.castRayAll(world, [-1, 0, 0], [400, 0, 0]).length, 300);
  assert.equal(full.overlapShape(world, full.box(400, 1, 1), [0, 0, 0]).length, 300);
  assert.equal(world.bodies().length, 300);
});

test("joints hold, turn and break", () => {
  const world = new full.World(lockstone, { bodyCapacity: 16, jointCapacity: 16 });
  const wall = world.createBody({ shape: full.box(1, 1, 1), motion: Motion.static });
  const arm = world.createBody({ shape: full.box(1, 0.1, 0.1), position: [2, 0, 0] });
  const hinge = full.createJoint(world, {
    kind: JointKind.hinge, a: wall, b: arm, frameA: { position: [1, 0, 0] }, frameB: { position: [-1, 0, 0] },
    angular: [{ speed: 2, maxEffort: 1e5 }], userData: 5n,
  });
  world.step(30);
  assert.ok(hinge.view.angle[0] > 0.5);
  assert.deepEqual(full.joints(world).map(({ id }) => id), [hinge.id]);
  assert.deepEqual(full.jointsOf(arm).map(({ id }) => id), [hinge.id]);
  hinge.setAngularAxis(0, { mode: full.AxisMode.free });
  hinge.destroy();
  assert.deepEqual(full.joints(world), []);
  full.createJoint(world, { kind: JointKind.ball, a: wall, b: arm, breakForce: 1, frameB: { position: [-9, 0, 0] }, userData: 8n });
  let broken = [];
  for (let i = 0; i < 10 && broken.length === 0; ++i) {
    world.step();
    broken = full.jointEvents(world);
  }
  assert.equal(broken[0]?.userData, 8n);
});

test("the core refuses things of the full file, and states with them", () => {
  assert.throws(() => new full.Assets(lockstone), /loadFull/);
  const here = ballAbove(lockstone), there = ballAbove(whole);
  assert.equal(here.world.hash, there.world.hash);
  assert.equal(lockstone.canaryHash, whole.canaryHash);
  const before = here.world.hash;
  assert.throws(() => full.describeDifference(here.world, new Uint8Array(8), new Uint8Array(8)), /loadFull/);
  for (const shape of [full.roundedBox(1, 1, 1, 0.25), full.taperedCapsule(1, 0.5, 0.25)])
    assert.throws(() => here.world.createBody({ shape }), { status: full.Status.invalidArgument });
  assert.equal(here.world.hash, before);
  full.loadState(here.world, full.saveState(there.world)); // the control
  there.world.createBody({ shape: full.roundedBox(1, 1, 1, 0.25) });
  assert.throws(() => full.loadState(here.world, full.saveState(there.world)), full.LockstoneError);
  const { heap } = whole;
  const fluid = heap.allocate(c.lks_fluid.$bytes);
  heap.check(heap.f.lks_fluid_init(fluid, c.lks_fluid.$bytes));
  heap.i32[(fluid + c.lks_fluid.density) >>> 2] = 1000 * 2 ** c.LKS_DENSITY_BITS;
  heap.putVector64(fluid + c.lks_fluid.extents, [5, 5, 5], c.LKS_POSITION_BITS);
  const wet = ballAbove(whole), dry = ballAbove(lockstone);
  heap.check(heap.f.lks_set_fluid(wet.world.address, 0, fluid));
  heap.f.free(fluid);
  assert.throws(() => full.loadState(dry.world, full.saveState(wet.world)), { statusName: "incompatible" });
});

test("the core and the full file compute the same", () => {
  const hashes = [lockstone, whole].map((module) => {
    const world = new full.World(module, { bodyCapacity: 128, jointCapacity: 8 });
    world.createBody({ shape: full.halfSpace(), motion: Motion.static });
    const kinds = [full.sphere("0.25"), full.box("0.3", "0.2", "0.25"), full.capsule("0.2", "0.2"), full.cylinder("0.2", "0.25"),
      full.cone("0.5", "0.25")];
    const bodies = Array.from({ length: 60 }, (_, i) => world.createBody({
      shape: kinds[i % kinds.length], position: [(i * 7 % 5) / 4, 0.5 + i / 3, (i * 3 % 4) / 4], angularVelocity: [1, i / 8, 0],
    }));
    full.createJoint(world, { kind: JointKind.ball, a: bodies[0], b: bodies[1], frameB: { position: [0, 1, 0] } });
    const seen = [];
    for (let i = 0; i < 30; ++i) {
      world.step(10);
      seen.push(world.hash);
    }
    return seen;
  });
  assert.deepEqual(hashes[0], hashes[1]);
});

test("hulls are assets of a world", () => {
  const lockstone = whole;
  const assets = new full.Assets(lockstone);
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]);
  const cube = assets.addHull(corners);
  const slab = assets.addScaled(cube, [2, "0.25", -1]);
  assert.equal(assets.addScaled(cube, [1, 1, 1]).asset, cube.asset);
  assert.throws(() => assets.addScaled(cube, [1, 0, 1]), /factors: /);
  const world = new full.World(lockstone, { bodyCapacity: 8, assets });
  world.createBody({ shape: full.halfSpace(), motion: Motion.static });
  const body = world.createBody({ shape: cube, position: [0, 3, 0] });
  const flat = world.createBody({ shape: slab, position: [9, 3, 0] });
  world.step(120);
  assert.ok(Math.abs(body.position[1] - 1) < 0.01);
  assert.ok(Math.abs(flat.position[1] - 0.25) < 0.01);
  assert.notEqual(full.configHash(lockstone, {}, assets), full.configHash(lockstone, {}));
});

test("two shapes are compared without a world", () => {
  const a = { shape: full.sphere("0.5"), position: [0, 0, 0] }, b = { shape: full.box(1, 1, 1), position: [0, 4, 0] };
  const gap = full.shapeDistance(whole, a, b);
  assert.ok(Math.abs(gap.distance - 2.5) < 2e-6 && !gap.overlapping);
  assert.deepEqual([...gap.normal, ...gap.pointA, ...gap.pointB].map((x) => Math.round(1000 * x) / 1000), [0, 1, 0, 0, 0.5, 0, 0, 3, 0]);
  assert.equal(full.shapeDistance(whole, a, b, 2), null);
  assert.equal(full.shapeDistance(whole, a, { ...b, position: [0, 1, 0] }).overlapping, true);
  const hit = full.shapeCast(whole, a, b, [0, -5, 0]);
  assert.ok(Math.abs(hit.fraction - 0.5) < 1e-6 && Math.abs(hit.point[1] - 0.5) < 2e-6);
  assert.equal(full.shapeCast(whole, a, b, [0, 5, 0]), null);
  const turned = { position: [0, 1.4, 0], orientation: [0, 0, Math.SQRT1_2, Math.SQRT1_2] };
  const impact = full.shapeImpact(whole, a, a, b, turned, 0.001);
  assert.ok(impact.fraction > 0.5 && impact.fraction < 1 && !impact.overlapping, `${impact.fraction}`);
  assert.equal(full.shapeImpact(whole, a, a, b, { position: [0, 8, 0] }), null);

  const assets = new full.Assets(whole);
  const cube = assets.addHull([0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]));
  const placed = { shape: cube, position: [0, 4, 0] };
  assert.ok(Math.abs(full.shapeDistance(whole, a, placed, 512, assets).distance - 2.5) < 2e-6);
  assert.throws(() => full.shapeDistance(whole, a, placed), /the set has no such asset/);
  assert.throws(() => full.shapeDistance(whole, a, { ...b, position: [0, 2000, 0] }), /out of range/);
  assert.throws(() => full.shapeDistance(lockstone, a, b), /needs the module of loadFull/);
});

test("a saved state is loaded in another world, and a snapshot in its own", () => {
  const lockstone = whole;
  const here = ballAbove(lockstone), there = ballAbove(lockstone);
  here.world.step(50);
  const bytes = full.saveState(here.world);
  const kept = new full.Snapshot(here.world);
  kept.save();
  assert.match(full.describeDifference(here.world, bytes, full.saveState(there.world)), /tick/);
  full.loadState(there.world, bytes);
  assert.equal(there.world.hash, here.world.hash);
  assert.equal(full.describeDifference(here.world, bytes, full.saveState(there.world)), null);
  const before = here.world.hash;
  here.world.step(10);
  const after = here.world.hash;
  kept.load();
  assert.equal(here.world.hash, before);
  here.world.step(10);
  assert.equal(here.world.hash, after);
  assert.deepEqual(Object.keys(full.partHashes(here.world)), ["total", "header", "bodies", "contacts", "joints"]);
  bytes[bytes.length - 1] ^= 1;
  assert.throws(() => full.loadState(there.world, bytes), full.LockstoneError);
});

test("a history makes a tick cheap that is stepped again", () => {
  const { world } = ballAbove(lockstone);
  world.keepHistory(16);
  const kept = new full.Snapshot(world);
  kept.save();
  world.step(5);
  const hash = world.hash;
  kept.load();
  const report = world.stepWithReport();
  assert.deepEqual([report.computedIslands, report.recalledIslands, report.status], [0, 1, 0]);
  world.step(4);
  assert.equal(world.hash, hash);
  world.forgetHistory();
});

test("poses are views of memory, and stay right when the memory grows", () => {
  const { world, ball } = ballAbove(lockstone);
  world.step();
  let poses = world.poses();
  assert.equal(poses.positions.buffer, lockstone.heap.f.memory.buffer);
  assert.deepEqual([...poses.bodies].length, 2);
  const y = () => Number(poses.positions[5 + 1]) / 2 ** 32;
  assert.equal(y(), ball.position[1]);
  const view = new full.View(world);
  view.update();
  const { buffer } = lockstone.heap.f.memory;
  new full.World(lockstone, { bodyCapacity: 1 << 14, contactCapacity: 1 << 16, pairCapacity: 1 << 16 });
  assert.notEqual(lockstone.heap.f.memory.buffer, buffer);
  world.step();
  poses = world.poses();
  assert.equal(y(), ball.position[1]);
  view.update();
  view.at(1);
  assert.equal(view.positions[3 * ball.index + 1], Math.fround(ball.position[1]));
});

test("a view shows poses between ticks", () => {
  const { world, ball } = ballAbove(lockstone, { gravity: [0, 0, 0] });
  ball.setVelocity([6, 0, 0]);
  ball.setAngularVelocity([0, 6, 0]);
  const view = new full.View(world, { origin: [100, 0, 0] });
  world.step();
  view.update();
  const row = ball.index;
  assert.ok(Math.abs(view.at(0.5).positions[3 * row] - (0.05 - 100)) < 1e-4);
  const turned = view.orientations.subarray(4 * row, 4 * row + 4);
  assert.ok(Math.abs(turned[1] - Math.sin(0.025)) < 1e-5 && Math.abs(turned[3] - Math.cos(0.025)) < 1e-5);
  assert.equal(view.bodies[row], ball.id);
  assert.equal(view.count, 2);
  ball.teleport([50, 10, 0]);
  world.step();
  view.update();
  assert.ok(Math.abs(view.at(0).positions[3 * row] - (50.1 - 100)) < 1e-3);
  view.moveOrigin([0, 0, 0]);
  assert.ok(Math.abs(view.at(0).positions[3 * row] - 50.1) < 1e-3);
  ball.destroy();
  view.update();
  assert.equal(view.bodies[row], 0n);
});

test("outlines have the parts and triangles of a shape", () => {
  const lockstone = whole;
  const assets = new full.Assets(lockstone);
  const corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const hull = assets.addHull(corners);
  const world = new full.World(lockstone, { bodyCapacity: 8, assets });
  const { parts: [part], triangles: none } = full.outlineOf(world.createBody({ shape: full.capsule(0.5, 0.25) }));
  assert.deepEqual([part.kind, ...part.size, none.length], [1, 0.25, 0.5, 0, 0]);
  assert.deepEqual([...part.axes], [1, 0, 0, 0, 1, 0, 0, 0, 1]);
  const { parts, triangles } = full.outlineOf(world.createBody({ shape: hull }));
  assert.equal(parts.length, 0);
  assert.equal(triangles.length, 4 * 9);
  const found = new Set(Array.from({ length: 12 }, (_, i) => triangles.slice(3 * i, 3 * i + 3).join()));
  assert.deepEqual([...found].sort(), corners.map(String).sort());
});

test("a destroyed world refuses calls, and is destroyed once", () => {
  const { world, ball } = ballAbove(lockstone);
  const view = new full.View(world), kept = new full.Snapshot(world);
  kept.save();
  for (let i = 0; i < 2; ++i) {
    world.destroy();
    kept.destroy();
  }
  for (const call of [() => world.step(), () => ball.position, () => view.at(0), () => view.update(), () => kept.save()]) {
    assert.throws(call);
  }
});

test("destroyed worlds give their memory back", () => {
  const bytes = () => lockstone.heap.f.memory.buffer.byteLength;
  const once = () => {
    const { world } = ballAbove(lockstone, { bodyCapacity: 4096 });
    world.step();
    world.poses();
    new full.View(world);
    world.destroy();
  };
  once();
  const before = bytes();
  for (let i = 0; i < 20; ++i) once();
  assert.equal(bytes(), before);
});
