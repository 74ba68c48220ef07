// A scene of a person's own, as JSON: the names and units of the npm package's definitions. docs/how-to/studio.md describes it.
import { type BodyDef, type Body, Lock, Motion } from "../../web/src/body.js";
import { type Axis, AxisMode, type JointDef, JointKind, createJoint } from "../../web/src/joints.js";
import * as shapes from "../../web/src/shapes.js";
import type { Quantity, Vector } from "../../web/src/units.js";
import { World, type WorldDef } from "../../web/src/world.js";
import type { Engine } from "./engine.js";

type Fields = Record<string, unknown>;
type Shapes = { [kind: string]: (sizes: readonly Quantity[], assets: shapes.Assets) => shapes.Shape };

const WORLD = ["bodyCapacity", "pairCapacity", "contactCapacity", "jointCapacity", "tickRate", "substeps", "sleepMs", "sleepDistance", "broadPhase",
  "gravity", "speedLimit", "convergedContacts"];
const BODY = ["position", "orientation", "velocity", "angularVelocity", "surface", "density", "surfaceMotion", "filter", "gravityScale",
  "linearDamping", "angularDamping", "trigger", "fixedRotation", "bullet", "allowSleep", "speedLimit", "angularSpeedLimit"];
const JOINT = ["frameA", "frameB", "linear", "angular", "groundA", "groundB", "ratio", "collide", "breakForce", "breakTorque"];
const SHAPES: Shapes = {
  sphere: ([radius]) => shapes.sphere(radius!), box: ([x, y, z]) => shapes.box(x!, y!, z!),
  capsule: ([halfHeight, radius]) => shapes.capsule(halfHeight!, radius!), cylinder: ([halfHeight, radius]) => shapes.cylinder(halfHeight!, radius!),
  cone: ([height, radius]) => shapes.cone(height!, radius!), taperedCapsule: ([height, bottom, top]) => shapes.taperedCapsule(height!, bottom!, top!),
  halfSpace: () => shapes.halfSpace(),
};
const SIZES: Record<string, number> = { sphere: 1, box: 3, capsule: 2, cylinder: 2, cone: 2, taperedCapsule: 3, halfSpace: 0 };

function object(value: unknown, where: string): Fields {
  if (typeof value !== "object" || value === null || Array.isArray(value)) throw new Error(`${where} is no object`);
  return value as Fields;
}

function items(value: unknown, where: string): unknown[] {
  if (value === undefined) return [];
  if (!Array.isArray(value)) throw new Error(`${where} is no list`);
  return value as unknown[];
}

/** The value that a name stands for. */
function named<Value>(names: Readonly<Record<string, Value>>, name: unknown, what: string): Value {
  if (typeof name !== "string" || !Object.hasOwn(names, name)) throw new Error(`${what} ${JSON.stringify(name)} is none of ${Object.keys(names).join(", ")}`);
  return names[name]!;
}

/** The fields that are allowed; any other is an error, so that a slip of the pen is found. */
function known(fields: Fields, allowed: readonly string[], others: readonly string[]): Fields {
  for (const name of Object.keys(fields)) if (!allowed.includes(name) && !others.includes(name)) throw new Error(`there is no field "${name}"`);
  return Object.fromEntries(Object.entries(fields).filter(([name]) => allowed.includes(name)));
}

function shapeOf(value: unknown, assets: shapes.Assets): shapes.Shape {
  const [[kind, sizes] = ["", null], ...more] = Object.entries(object(value, "the shape"));
  if (more.length > 0) throw new Error("a shape has one kind");
  if (kind === "hull") return assets.addHull(items(sizes, "hull") as Vector[]);
  const make = named(SHAPES, kind, "the shape");
  const list = (Array.isArray(sizes) ? sizes : kind === "halfSpace" ? [] : [sizes]) as Quantity[];
  if (list.length !== SIZES[kind]) throw new Error(`${kind} has ${SIZES[kind]} sizes`);
  return make(list, assets);
}

/** Runs `act`; an error of it says where it was. */
function at<Result>(where: string, act: () => Result): Result {
  try {
    return act();
  } catch (error) {
    throw new Error(`${where}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

export class OwnScene {
  readonly name: string;
  private readonly fields: Fields;

  /** `text`: JSON. Errors name the place in words. */
  constructor(text: string, fileName: string) {
    this.fields = at(fileName, () => object(JSON.parse(text), "the scene"));
    this.name = typeof this.fields["name"] === "string" ? this.fields["name"] : fileName;
  }

  makeWorld({ lockstone }: Engine): World {
    const definition = at("the scene", () => known(this.fields, WORLD, ["name", "bodies", "joints"])) as WorldDef;
    const list = items(this.fields["bodies"], "bodies").map((body, i) => at(`bodies[${i}]`, () => object(body, "it")));
    const assets = new shapes.Assets(lockstone);
    const made = list.map((fields, i) => at(`bodies[${i}]`, () => this.bodyOf(fields, assets)));
    const world = new World(lockstone, { ...definition, assets });
    try {
      const bodies = made.map((body, i) => at(`bodies[${i}]`, () => world.createBody(body)));
      const byName = new Map(list.flatMap(({ name }, i): [unknown, Body][] => (name === undefined ? [] : [[name, bodies[i]!]])));
      items(this.fields["joints"], "joints").forEach((joint, i) => at(`joints[${i}]`, () => createJoint(world, this.jointOf(object(joint, "it"), bodies, byName))));
      return world;
    } catch (error) {
      world.destroy();
      throw error;
    }
  }

  private bodyOf(fields: Fields, assets: shapes.Assets): BodyDef {
    const { motion = "dynamic", locks } = fields;
    return {
      ...known(fields, BODY, ["name", "shape", "motion", "locks"]), shape: shapeOf(fields["shape"], assets), motion: named(Motion, motion, "the motion"),
      locks: items(locks, "locks").reduce((bits: number, name) => bits | named(Lock, name, "the lock"), 0),
    };
  }

  private jointOf(fields: Fields, bodies: readonly Body[], byName: ReadonlyMap<unknown, Body>): JointDef {
    const end = (name: "a" | "b") => {
      const value = fields[name];
      const body = typeof value === "number" ? bodies[value] : byName.get(value);
      if (!body) throw new Error(`${name}: there is no body ${JSON.stringify(value)}`);
      return body;
    };
    const { linear, angular, ...rest } = known(fields, JOINT, ["kind", "a", "b"]);
    const axes = (list: unknown) => items(list, "axes").map((one) => this.axisOf(object(one, "the axis"))) as [Axis?, Axis?, Axis?];
    return { ...rest, kind: named(JointKind, fields["kind"], "the joint"), a: end("a"), b: end("b"), linear: axes(linear), angular: axes(angular) };
  }

  private axisOf({ mode, ...rest }: Fields): Axis {
    return mode === undefined ? rest : { ...rest, mode: named(AxisMode, mode, "the mode") };
  }
}
