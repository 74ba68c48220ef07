import { Body } from "./body.js";
import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import { list, listAll } from "./list.js";
import type { Numbers3, Quantity, Rotation, Vector } from "./units.js";
import type { World } from "./world.js";

export const JointKind = {
  distance: c.LKS_JOINT_DISTANCE,
  ball: c.LKS_JOINT_BALL,
  hinge: c.LKS_JOINT_HINGE,
  slider: c.LKS_JOINT_SLIDER,
  weld: c.LKS_JOINT_WELD,
  wheel: c.LKS_JOINT_WHEEL,
  motor: c.LKS_JOINT_MOTOR,
  sixAxis: c.LKS_JOINT_SIX_AXIS,
  pulley: c.LKS_JOINT_PULLEY,
  gear: c.LKS_JOINT_GEAR,
  rack: c.LKS_JOINT_RACK,
  ratchet: c.LKS_JOINT_RATCHET,
  path: c.LKS_JOINT_PATH,
} as const;

export const AxisMode = { locked: c.LKS_AXIS_LOCKED, free: c.LKS_AXIS_FREE, limited: c.LKS_AXIS_LIMITED } as const;

/**
 * One way to move. Of a linear axis `lower`, `upper` and `target` are m, `speed` m/s, `maxEffort` N;
 * of an angular one rad, rad/s, N·m. The drive is on when `hertz` or `maxEffort` is above 0: a motor
 * without hertz, a spring with them.
 */
export interface Axis {
  /** One of `AxisMode`. */
  mode?: number;
  lower?: Quantity;
  upper?: Quantity;
  target?: Quantity;
  speed?: Quantity;
  /** 0 … 1000. */
  hertz?: Quantity;
  /** 0 … 100. */
  dampingRatio?: Quantity;
  maxEffort?: Quantity;
}

/** Where a joint sits on a body: in the frame of its shape. */
export interface JointFrame {
  position?: Vector;
  orientation?: Rotation;
}

/** A joint to be made. Its kind locks and frees the axes; those that are given change the settings they name. */
export interface JointDef {
  /** One of `JointKind`. */
  kind: number;
  a: Body;
  b: Body;
  frameA?: JointFrame;
  frameB?: JointFrame;
  /** Along x, y, z. */
  linear?: readonly [Axis?, Axis?, Axis?];
  /** Twist about x, swing about y and z. */
  angular?: readonly [Axis?, Axis?, Axis?];
  /** Pulley: the fixed points. */
  groundA?: Vector;
  groundB?: Vector;
  /** Pulley, gear, rack; ratchet: teeth in a turn, whole, 2 … 1000. */
  ratio?: Quantity;
  /** The two bodies may touch. */
  collide?: boolean;
  /** N: the joint is destroyed beyond it; 0: never. */
  breakForce?: Quantity;
  /** N·m. */
  breakTorque?: Quantity;
  userData?: bigint;
  /** Path joint: its path, from `Assets.addPath`. */
  path?: bigint;
}

/** A joint as it stands after the last step. */
export interface JointView {
  kind: number;
  a: Body;
  b: Body;
  userData: bigint;
  /** m, of frame B against frame A, along the axes of A. */
  offset: Numbers3;
  /** rad: twist and swing. */
  angle: Numbers3;
  /** N, on body b in the last substep, along the joint's axes. */
  force: Numbers3;
  /** N·m. */
  torque: Numbers3;
}

const def = c.lks_joint_def;
const axis = c.lks_axis;

function putAxis(heap: Heap, at: number, from: Axis, angular: boolean): void {
  const way = angular ? c.LKS_ANGLE_BITS : c.LKS_LENGTH_BITS;
  const rate = angular ? c.LKS_RATE_BITS : c.LKS_SPEED_BITS;
  if (from.mode !== undefined) heap.putWord(at + axis.mode, from.mode);
  if (from.lower !== undefined) heap.put32(at + axis.lower, from.lower, way);
  if (from.upper !== undefined) heap.put32(at + axis.upper, from.upper, way);
  if (from.target !== undefined) heap.put32(at + axis.target, from.target, way);
  if (from.speed !== undefined) heap.put32(at + axis.speed, from.speed, rate);
  if (from.hertz !== undefined) heap.put32(at + axis.hertz, from.hertz, c.LKS_NUMBER_BITS);
  if (from.dampingRatio !== undefined) heap.put32(at + axis.damping_ratio, from.dampingRatio, c.LKS_NUMBER_BITS);
  if (from.maxEffort !== undefined) heap.put64(at + axis.max_effort, from.maxEffort, c.LKS_FORCE_BITS);
}

function putAxes(heap: Heap, at: number, axes: readonly (Axis | undefined)[], angular: boolean): void {
  axes.forEach((from, i) => {
    if (from) putAxis(heap, at + i * axis.$bytes, from, angular);
  });
}

function putFrame(heap: Heap, at: number, { position, orientation }: JointFrame): void {
  if (position) heap.putVector32(at + c.lks_joint_frame.position, position, c.LKS_LENGTH_BITS);
  if (orientation) heap.putRotation(at + c.lks_joint_frame.orientation, orientation);
}

function putDef(heap: Heap, at: number, from: JointDef): void {
  heap.check(heap.f.lks_joint_def_init(at, def.$bytes, from.kind, from.a.id, from.b.id));
  if (from.frameA) putFrame(heap, at + def.frame_a, from.frameA);
  if (from.frameB) putFrame(heap, at + def.frame_b, from.frameB);
  if (from.linear) putAxes(heap, at + def.linear, from.linear, false);
  if (from.angular) putAxes(heap, at + def.angular, from.angular, true);
  if (from.groundA) heap.putVector64(at + def.ground_a, from.groundA, c.LKS_POSITION_BITS);
  if (from.groundB) heap.putVector64(at + def.ground_b, from.groundB, c.LKS_POSITION_BITS);
  if (from.ratio !== undefined) heap.put32(at + def.ratio, from.ratio, c.LKS_NUMBER_BITS);
  if (from.collide) heap.putWord(at + def.collide, 1);
  if (from.breakForce !== undefined) heap.put64(at + def.break_force, from.breakForce, c.LKS_FORCE_BITS);
  if (from.breakTorque !== undefined) heap.put64(at + def.break_torque, from.breakTorque, c.LKS_FORCE_BITS);
  if (from.userData !== undefined) heap.i64[(at + def.user_data) >>> 3] = from.userData;
  if (from.path !== undefined) heap.u64[(at + def.path) >>> 3] = from.path;
}

/** Names a joint of a world. The name of a destroyed joint never names another one. */
export class Joint {
  constructor(readonly world: World, readonly id: bigint) {}

  destroy(): void {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_destroy_joint(address, this.id));
  }

  /** New settings for one axis, limits and drive alike: those that are left out are 0, and the mode locked. */
  setLinearAxis(index: 0 | 1 | 2, settings: Axis): void {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_set_linear_axis(address, this.id, index, this.put(settings, false)));
  }

  setAngularAxis(index: 0 | 1 | 2, settings: Axis): void {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_set_angular_axis(address, this.id, index, this.put(settings, true)));
  }

  get view(): JointView {
    const { world } = this;
    const { heap, address } = world;
    const at = heap.output;
    const view = c.lks_joint_view;
    heap.putWord(at, view.$bytes);
    heap.check(heap.f.lks_joint_get(address, this.id, at));
    return {
      kind: heap.getWord(at + view.kind),
      a: new Body(world, heap.getId(at + view.body_a)),
      b: new Body(world, heap.getId(at + view.body_b)),
      userData: heap.getId(at + view.user_data),
      offset: heap.getVector32(at + view.offset, c.LKS_LENGTH_BITS),
      angle: heap.getVector32(at + view.angle, c.LKS_ANGLE_BITS),
      force: heap.getVector64(at + view.force, c.LKS_FORCE_BITS),
      torque: heap.getVector64(at + view.torque, c.LKS_FORCE_BITS),
    };
  }

  private put(settings: Axis, angular: boolean): number {
    const { heap } = this.world;
    heap.u8.fill(0, heap.input, heap.input + axis.$bytes);
    putAxis(heap, heap.input, settings, angular);
    return heap.input;
  }
}

export function createJoint(world: World, definition: JointDef): Joint {
  const { heap } = world;
  putDef(heap, heap.input, definition);
  heap.check(heap.f.lks_create_joint(world.address, heap.input, heap.output));
  return new Joint(world, heap.getId(heap.output));
}

/** All joints by ascending index. */
export function joints(world: World): Joint[] {
  const { heap } = world;
  return list(heap, 8, (...to) => heap.f.lks_joints(world.address, ...to), (at) => new Joint(world, heap.getId(at)));
}

/** The joints of a body. */
export function jointsOf({ world, id }: Body): Joint[] {
  const { heap } = world;
  return listAll(heap, 8, (...to) => heap.f.lks_joints_of(world.address, id, ...to),
    (at) => new Joint(world, heap.getId(at)));
}

/** A joint broke in the last step. */
export interface JointEvent {
  joint: Joint;
  a: Body;
  b: Body;
  userData: bigint;
}

export function jointEvents(world: World): JointEvent[] {
  const { heap } = world;
  const event = c.lks_joint_event;
  return list(heap, event.$bytes, (...to) => heap.f.lks_joint_events(world.address, ...to), (at) => ({
    joint: new Joint(world, heap.getId(at + event.joint)),
    a: new Body(world, heap.getId(at + event.a)),
    b: new Body(world, heap.getId(at + event.b)),
    userData: heap.getId(at + event.user_data),
  }));
}
