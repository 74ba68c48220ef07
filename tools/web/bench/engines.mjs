// The engines, each at its defaults but that nothing sleeps: how it is loaded, its files, and the scene in it.
// `top` is the place of the last box.
import { createRequire } from "node:module";
import { fileURLToPath, pathToFileURL } from "node:url";

import { DENSITY, FLOOR, FRICTION, GRAVITY, HALF, pyramid } from "./scene.mjs";

const build = fileURLToPath(new URL("../../../build/web/", import.meta.url));
const modules = `${build}node/node_modules/`;
const node = createRequire(`${build}node/`);
const versionOf = (name) => node(`${modules}${name}/package.json`).version;
const code = (address) => import(pathToFileURL(address));
const ours = ["index", "body", "declarations", "errors", "events", "heap", "joints", "list", "load", "outline", "queries", "shapes",
  "state", "units", "view", "world"].map((name) => `${build}package/dist/${name}.js`);

function lockstone(simd, rules = {}) {
  const wasm = `${build}package/dist/lockstone${simd ? "-simd" : ""}.wasm`;
  return {
    name: `Lockstone ${simd ? "with" : "without"} vectors${rules.convergedContacts === 0 ? ", iterated" : ""}`,
    version: versionOf("../../package"),
    files: [...ours, wasm],
    async load() {
      const module = await code(`${build}package/dist/index.js`);
      return { module, loaded: await module.load({ simd }) };
    },
    make({ module, loaded }) {
      const capacities = { bodyCapacity: 512, pairCapacity: 4096, contactCapacity: 2048 };
      const world = new module.World(loaded, { ...capacities, sleepMs: 0, gravity: [0, GRAVITY, 0], ...rules });
      const surface = { friction: FRICTION };
      world.createBody({ shape: module.box(...FLOOR.half), motion: module.Motion.static, position: FLOOR.position, surface });
      const boxes = pyramid().map((position) =>
        world.createBody({ shape: module.box(HALF, HALF, HALF), position, surface, density: DENSITY }));
      return { step: () => world.step(), top: () => boxes.at(-1).position, hash: () => world.hash };
    },
  };
}

function rapier(name) {
  const package_ = `@dimforge/${name}`;
  return {
    name: package_,
    version: versionOf(package_),
    files: [`${modules}${package_}/dist/rapier.mjs`],
    async load() {
      const module = await code(`${modules}${package_}/dist/rapier.mjs`);
      await module.init();
      return module;
    },
    make(rapier) {
      const world = new rapier.World({ x: 0, y: GRAVITY, z: 0 });
      world.timestep = 1 / 60;
      const add = (desc, [x, y, z], half) => {
        const body = world.createRigidBody(desc.setTranslation(x, y, z).setCanSleep(false));
        world.createCollider(rapier.ColliderDesc.cuboid(...half).setDensity(DENSITY).setFriction(FRICTION), body);
        return body;
      };
      add(rapier.RigidBodyDesc.fixed(), FLOOR.position, FLOOR.half);
      const boxes = pyramid().map((at) => add(rapier.RigidBodyDesc.dynamic(), at, [HALF, HALF, HALF]));
      return { step: () => world.step(), top: () => Object.values(boxes.at(-1).translation()) };
    },
  };
}

const jolt = {
  name: "jolt-physics",
  version: versionOf("jolt-physics"),
  files: ["js", "wasm"].map((kind) => `${modules}jolt-physics/dist/jolt-physics.wasm.${kind}`),
  async load() {
    return (await code(`${modules}jolt-physics/dist/jolt-physics.wasm.js`)).default();
  },
  make(jolt) {
    const settings = new jolt.JoltSettings();
    settings.mMaxWorkerThreads = 0;
    const pairs = new jolt.ObjectLayerPairFilterTable(2);
    pairs.EnableCollision(0, 1);
    pairs.EnableCollision(1, 1);
    const broad = new jolt.BroadPhaseLayerInterfaceTable(2, 2);
    broad.MapObjectToBroadPhaseLayer(0, new jolt.BroadPhaseLayer(0));
    broad.MapObjectToBroadPhaseLayer(1, new jolt.BroadPhaseLayer(1));
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = broad;
    settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 2, pairs, 2);
    const whole = new jolt.JoltInterface(settings);
    const bodies = whole.GetPhysicsSystem().GetBodyInterface();
    const add = (motion, layer, at, half) => {
      const shape = new jolt.BoxShape(new jolt.Vec3(...half));
      shape.SetDensity(DENSITY);
      const made = new jolt.BodyCreationSettings(shape, new jolt.RVec3(...at), new jolt.Quat(0, 0, 0, 1), motion, layer);
      made.mFriction = FRICTION;
      made.mAllowSleeping = false;
      const body = bodies.CreateBody(made);
      bodies.AddBody(body.GetID(), jolt.EActivation_Activate);
      return body;
    };
    add(jolt.EMotionType_Static, 0, FLOOR.position, FLOOR.half);
    const boxes = pyramid().map((at) => add(jolt.EMotionType_Dynamic, 1, at, [HALF, HALF, HALF]));
    const top = () => {
      const place = boxes.at(-1).GetPosition();
      return [place.GetX(), place.GetY(), place.GetZ()];
    };
    return { step: () => whole.Step(1 / 60, 1), top };
  },
};

export const engines = {
  simd: lockstone(true),
  iterated: lockstone(true, { convergedContacts: 0 }),
  plain: lockstone(false),
  rapier: rapier("rapier3d-compat"),
  deterministic: rapier("rapier3d-deterministic-compat"),
  jolt,
};
