import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import { type Shape, getShape, putShape } from "./shapes.js";
import type { Numbers3, Numbers4, Quantity, Rotation, Vector } from "./units.js";
import type { World } from "./world.js";

export const Motion = { static: c.LKS_STATIC, kinematic: c.LKS_KINEMATIC, dynamic: c.LKS_DYNAMIC } as const;

/** How a property of two surfaces becomes one of the pair. */
export const Combine = {
  standard: c.LKS_COMBINE_STANDARD,
  average: c.LKS_COMBINE_AVERAGE,
  geometricMean: c.LKS_COMBINE_GEOMETRIC_MEAN,
  minimum: c.LKS_COMBINE_MINIMUM,
  multiply: c.LKS_COMBINE_MULTIPLY,
  maximum: c.LKS_COMBINE_MAXIMUM,
} as const;

/** Bits of `locks`: world axes that a dynamic body does not move along, or turn about. */
export const Lock = {
  moveX: c.LKS_LOCK_MOVE_X,
  moveY: c.LKS_LOCK_MOVE_Y,
  moveZ: c.LKS_LOCK_MOVE_Z,
  turnX: c.LKS_LOCK_TURN_X,
  turnY: c.LKS_LOCK_TURN_Y,
  turnZ: c.LKS_LOCK_TURN_Z,
} as const;

export interface Surface {
  /** 0 … 1.99. */
  friction?: Quantity;
  /** 0 … 1. */
  restitution?: Quantity;
  /** 0 … 1. */
  rollingResistance?: Quantity;
  /** One of `Combine`. */
  frictionRule?: number;
  restitutionRule?: number;
  rollingRule?: number;
  /** The game's own; found in events and queries. */
  tag?: number;
}

/** The motion of a surface that stays in place, as of a belt, in the axes of the body's shape. */
export interface SurfaceMotion {
  /** m/s, each component within ±500. */
  velocity?: Vector;
  /** rad/s, each within ±500. */
  turning?: Vector;
}

/** With an equal group other than 0 the sign decides: positive always meets, negative never. Else both must find the other's category in their mask. */
export interface Filter {
  category?: number;
  mask?: number;
  group?: number;
}

/** A body to be made. Fields that are left out have the library's defaults. */
export interface BodyDef {
  shape: Shape;
  /** One of `Motion`; dynamic. */
  motion?: number;
  /** m, of the shape's frame, within ±2^20. */
  position?: Vector;
  orientation?: Rotation;
  /** m/s, of the centre of mass. */
  velocity?: Vector;
  /** rad/s. */
  angularVelocity?: Vector;
  surface?: Surface;
  /** kg/m³; 1000. */
  density?: Quantity;
  /** Of static and kinematic bodies. */
  surfaceMotion?: SurfaceMotion;
  filter?: Filter;
  gravityScale?: Quantity;
  /** 1/s. */
  linearDamping?: Quantity;
  angularDamping?: Quantity;
  /** Reports overlaps, pushes nothing. */
  trigger?: boolean;
  fixedRotation?: boolean;
  /** Never passes through dynamic bodies either. */
  bullet?: boolean;
  /** true. */
  allowSleep?: boolean;
  /** Bits of `Lock`. */
  locks?: number;
  /** m/s. */
  speedLimit?: Quantity;
  /** rad/s. */
  angularSpeedLimit?: Quantity;
  /** The game's own, 64 bits; part of the state. */
  userData?: bigint;
  /** true: contacts of the body are events. */
  contactEvents?: boolean;
  /** true: a contact of the body that goes on is an event in every tick. */
  persistEvents?: boolean;
  /** m/s: approaches above it are hits; 0: none are. */
  hitSpeed?: Quantity;
}

/** A body as it stands. */
export interface BodyView {
  motion: number;
  shape: Shape;
  position: Numbers3;
  orientation: Numbers4;
  centreOfMass: Numbers3;
  velocity: Numbers3;
  angularVelocity: Numbers3;
  /** kg, rounded to a double; 0 of static and kinematic bodies. */
  mass: number;
  friction: number;
  restitution: number;
  tag: number;
  asleep: boolean;
  trigger: boolean;
  locks: number;
  userData: bigint;
}

const def = c.lks_body_def;
const surface = c.lks_surface;

function putSurface(heap: Heap, at: number, from: Surface): void {
  if (from.friction !== undefined) heap.put32(at + surface.friction, from.friction, c.LKS_UNIT_BITS);
  if (from.restitution !== undefined) heap.put32(at + surface.restitution, from.restitution, c.LKS_UNIT_BITS);
  if (from.rollingResistance !== undefined) heap.put32(at + surface.rolling_resistance, from.rollingResistance, c.LKS_UNIT_BITS);
  if (from.frictionRule !== undefined) heap.putWord(at + surface.friction_rule, from.frictionRule);
  if (from.restitutionRule !== undefined) heap.putWord(at + surface.restitution_rule, from.restitutionRule);
  if (from.rollingRule !== undefined) heap.putWord(at + surface.rolling_rule, from.rollingRule);
  if (from.tag !== undefined) heap.putWord(at + surface.tag, from.tag);
}

function putSurfaceMotion(heap: Heap, at: number, { velocity = [0, 0, 0], turning = [0, 0, 0] }: SurfaceMotion): void {
  heap.putVector32(at + c.lks_surface_motion.velocity, velocity, c.LKS_SPEED_BITS);
  heap.putVector32(at + c.lks_surface_motion.turning, turning, c.LKS_RATE_BITS);
}

function putFilter(heap: Heap, at: number, { category = 1, mask = 0xffffffff, group = 0 }: Filter): void {
  heap.putWord(at + c.lks_filter.category, category);
  heap.putWord(at + c.lks_filter.mask, mask);
  heap.putWord(at + c.lks_filter.group, group);
}

function putPose(heap: Heap, at: number, position: Vector, orientation: Rotation): void {
  heap.putVector64(at + c.lks_pose.position, position, c.LKS_POSITION_BITS);
  heap.putRotation(at + c.lks_pose.orientation, orientation);
}

function eventBits(contacts: boolean, persist: boolean): number {
  return (contacts ? c.LKS_BODY_CONTACT_EVENTS : 0) | (persist ? c.LKS_BODY_PERSIST_EVENTS : 0);
}

function putFlags(heap: Heap, at: number, from: BodyDef): void {
  const flags = (from.trigger ? c.LKS_BODY_TRIGGER : 0) | (from.fixedRotation ? c.LKS_BODY_FIXED_ROTATION : 0) |
    (from.bullet ? c.LKS_BODY_BULLET : 0) | (from.allowSleep === false ? 0 : c.LKS_BODY_ALLOW_SLEEP);
  heap.putWord(at + def.flags, flags);
  if (from.locks !== undefined) heap.putWord(at + def.locks, from.locks);
  heap.putWord(at + def.events, eventBits(from.contactEvents ?? true, from.persistEvents ?? false));
  if (from.userData !== undefined) heap.i64[(at + def.user_data) >>> 3] = from.userData;
}

/** Writes a definition to `heap.input`. */
export function putBodyDef(heap: Heap, from: BodyDef): void {
  const at = heap.input;
  heap.check(heap.f.lks_body_def_init(at, def.$bytes));
  putShape(heap, at + def.shape, from.shape);
  putFlags(heap, at, from);
  if (from.motion !== undefined) heap.putWord(at + def.motion, from.motion);
  if (from.position) heap.putVector64(at + def.position, from.position, c.LKS_POSITION_BITS);
  if (from.orientation) heap.putRotation(at + def.orientation, from.orientation);
  if (from.velocity) heap.putVector64(at + def.velocity, from.velocity, c.LKS_VELOCITY_BITS);
  if (from.angularVelocity) heap.putVector64(at + def.angular_velocity, from.angularVelocity, c.LKS_ANGULAR_VELOCITY_BITS);
  if (from.surface) putSurface(heap, at + def.surface, from.surface);
  if (from.density !== undefined) heap.put32(at + def.density, from.density, c.LKS_DENSITY_BITS);
  if (from.surfaceMotion) putSurfaceMotion(heap, at + def.surface_motion, from.surfaceMotion);
  if (from.filter) putFilter(heap, at + def.filter, from.filter);
  if (from.gravityScale !== undefined) heap.put32(at + def.gravity_scale, from.gravityScale, c.LKS_NUMBER_BITS);
  if (from.linearDamping !== undefined) heap.put32(at + def.linear_damping, from.linearDamping, c.LKS_RATE_BITS);
  if (from.angularDamping !== undefined) heap.put32(at + def.angular_damping, from.angularDamping, c.LKS_RATE_BITS);
  if (from.speedLimit !== undefined) heap.put64(at + def.speed_limit, from.speedLimit, c.LKS_VELOCITY_BITS);
  if (from.angularSpeedLimit !== undefined) {
    heap.put64(at + def.angular_speed_limit, from.angularSpeedLimit, c.LKS_ANGULAR_VELOCITY_BITS);
  }
  if (from.hitSpeed !== undefined) heap.put32(at + def.hit_speed, from.hitSpeed, c.LKS_SPEED_BITS);
}

/** Names a body of a world, and gives it commands. The name of a destroyed body never names another one. */
export class Body {
  constructor(
    readonly world: World,
    /** Index in the low half, generation in the high one. */
    readonly id: bigint,
  ) {}

  /** The body's row in a `View`, and its place among other things of a slot each. */
  get index(): number {
    return Number(this.id & 0xffffffffn);
  }

  equals(other: Body): boolean {
    return this.world === other.world && this.id === other.id;
  }

  get exists(): boolean {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_body_exists(address, this.id, heap.output));
    return heap.getWord(heap.output) === 1;
  }

  /** m, of the shape's frame. */
  get position(): Numbers3 {
    return this.world.heap.getVector64(this.readPose(), c.LKS_POSITION_BITS);
  }

  get orientation(): Numbers4 {
    return this.world.heap.getRotation(this.readPose() + c.lks_pose.orientation);
  }

  /** m/s, of the centre of mass. */
  get velocity(): Numbers3 {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_body_velocity(address, this.id, heap.output));
    return heap.getVector64(heap.output, c.LKS_VELOCITY_BITS);
  }

  /** All that the library tells of it. */
  get view(): BodyView {
    const { heap, address } = this.world;
    const at = heap.output;
    const view = c.lks_body_view;
    heap.putWord(at, view.$bytes);
    heap.check(heap.f.lks_body_get(address, this.id, at));
    const flags = heap.getWord(at + view.flags);
    return {
      motion: heap.getWord(at + view.motion),
      shape: getShape(heap, at + view.shape),
      position: heap.getVector64(at + view.position, c.LKS_POSITION_BITS),
      orientation: heap.getRotation(at + view.orientation),
      centreOfMass: heap.getVector64(at + view.centre_of_mass, c.LKS_POSITION_BITS),
      velocity: heap.getVector64(at + view.velocity, c.LKS_VELOCITY_BITS),
      angularVelocity: heap.getVector64(at + view.angular_velocity, c.LKS_ANGULAR_VELOCITY_BITS),
      mass: heap.get64(at + view.mass, c.LKS_MASS_BITS),
      friction: heap.get32(at + view.surface + surface.friction, c.LKS_UNIT_BITS),
      restitution: heap.get32(at + view.surface + surface.restitution, c.LKS_UNIT_BITS),
      tag: heap.getWord(at + view.surface + surface.tag),
      asleep: (flags & c.LKS_BODY_ASLEEP) !== 0,
      trigger: (flags & c.LKS_BODY_TRIGGER) !== 0,
      locks: heap.getWord(at + view.locks),
      userData: heap.getId(at + view.user_data),
    };
  }

  destroy(): void {
    this.order((f, world) => f.lks_destroy_body(world, this.id));
  }

  /** Moves a body at once; its contacts end. */
  teleport(position: Vector, orientation: Rotation = [0, 0, 0, 1]): void {
    this.order((f, world, at, heap) => {
      putPose(heap, at, position, orientation);
      return f.lks_teleport(world, this.id, at);
    });
  }

  /** Gives a kinematic body the velocities that take it there in one tick. */
  moveKinematic(position: Vector, orientation: Rotation = [0, 0, 0, 1]): void {
    this.order((f, world, at, heap) => {
      putPose(heap, at, position, orientation);
      return f.lks_move_kinematic(world, this.id, at);
    });
  }

  setVelocity(velocity: Vector): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, velocity, c.LKS_VELOCITY_BITS);
      return f.lks_set_velocity(world, this.id, at);
    });
  }

  setAngularVelocity(velocity: Vector): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, velocity, c.LKS_ANGULAR_VELOCITY_BITS);
      return f.lks_set_angular_velocity(world, this.id, at);
    });
  }

  /**
   * N·s, at the centre of mass or at a point within twice the body's radius of it; in the world's
   * axes, the point relative to the centre of mass, or all in the body's own frame.
   */
  applyImpulse(impulse: Vector, point?: Vector, ownFrame = false): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, impulse, c.LKS_IMPULSE_BITS);
      if (!point) return f.lks_apply_impulse(world, this.id, at, Number(ownFrame));
      heap.putVector32(at + 24, point, c.LKS_LENGTH_BITS);
      return f.lks_apply_impulse_at(world, this.id, at, at + 24, Number(ownFrame));
    });
  }

  /** N·m·s. */
  applyAngularImpulse(impulse: Vector, ownFrame = false): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, impulse, c.LKS_IMPULSE_BITS);
      return f.lks_apply_angular_impulse(world, this.id, at, Number(ownFrame));
    });
  }

  /** N, over the coming tick; as `applyImpulse`. */
  applyForce(force: Vector, point?: Vector, ownFrame = false): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, force, c.LKS_FORCE_BITS);
      if (!point) return f.lks_apply_force(world, this.id, at, Number(ownFrame));
      heap.putVector32(at + 24, point, c.LKS_LENGTH_BITS);
      return f.lks_apply_force_at(world, this.id, at, at + 24, Number(ownFrame));
    });
  }

  /** N·m, over the coming tick. */
  applyTorque(torque: Vector, ownFrame = false): void {
    this.order((f, world, at, heap) => {
      heap.putVector64(at, torque, c.LKS_FORCE_BITS);
      return f.lks_apply_torque(world, this.id, at, Number(ownFrame));
    });
  }

  /** Fields that are left out have the defaults of a new body, not the present ones. */
  setSurface(values: Surface): void {
    this.order((f, world, at, heap) => {
      heap.check(f.lks_body_def_init(at, def.$bytes));
      putSurface(heap, at + def.surface, values);
      return f.lks_set_material(world, this.id, at + def.surface);
    });
  }

  setSurfaceMotion(motion: SurfaceMotion): void {
    this.order((f, world, at, heap) => {
      putSurfaceMotion(heap, at, motion);
      return f.lks_set_surface_motion(world, this.id, at);
    });
  }

  setGravityScale(scale: Quantity): void {
    this.order((f, world, at, heap) => {
      heap.put32(at, scale, c.LKS_NUMBER_BITS);
      return f.lks_set_gravity_scale(world, this.id, heap.i32[at >>> 2]!);
    });
  }

  /** 1/s. */
  setDamping(linear: Quantity, angular: Quantity): void {
    this.order((f, world, at, heap) => {
      heap.put32(at, linear, c.LKS_RATE_BITS);
      heap.put32(at + 4, angular, c.LKS_RATE_BITS);
      return f.lks_set_damping(world, this.id, heap.i32[at >>> 2]!, heap.i32[(at >>> 2) + 1]!);
    });
  }

  /** Bits of `Lock`. */
  setLocks(locks: number): void {
    this.order((f, world) => f.lks_set_axis_locks(world, this.id, locks));
  }

  /** m/s and rad/s. */
  setSpeedLimit(linear: Quantity, angular: Quantity): void {
    this.order((f, world, at, heap) => {
      heap.put64(at, linear, c.LKS_VELOCITY_BITS);
      heap.put64(at + 8, angular, c.LKS_ANGULAR_VELOCITY_BITS);
      return f.lks_set_speed_limit(world, this.id, heap.i64[at >>> 3]!, heap.i64[(at >>> 3) + 1]!);
    });
  }

  setFilter(filter: Filter): void {
    this.order((f, world, at, heap) => {
      putFilter(heap, at, filter);
      return f.lks_set_filter(world, this.id, at);
    });
  }

  /** Whether contacts of the body are events, above which approach speed (m/s) they are hits, and whether those that go on are
   *  events in every tick. Changes no motion. */
  setEvents(contacts: boolean, hitSpeed: Quantity = 0, persist = false): void {
    this.order((f, world, at, heap) => {
      heap.put32(at, hitSpeed, c.LKS_SPEED_BITS);
      return f.lks_set_events(world, this.id, eventBits(contacts, persist), heap.i32[at >>> 2]!);
    });
  }

  setUserData(data: bigint): void {
    this.order((f, world) => f.lks_set_user_data(world, this.id, data));
  }

  /** Names the body for people: not state. 28 bytes of UTF-8 and no more are kept. */
  setName(name: string): void {
    this.order((f, world, _, heap) => f.lks_set_name(world, this.id, heap.putText(name)));
  }

  /** Wakes the body and its island; commands that push or move a body do so by themselves. */
  wake(): void {
    this.order((f, world) => f.lks_wake_body(world, this.id));
  }

  sleep(): void {
    this.order((f, world) => f.lks_sleep_body(world, this.id));
  }

  setAllowSleep(allow: boolean): void {
    this.order((f, world) => f.lks_set_allow_sleep(world, this.id, Number(allow)));
  }

  private readPose(): number {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_body_pose(address, this.id, heap.output));
    return heap.output;
  }

  private order(call: (f: Heap["f"], world: number, input: number, heap: Heap) => number): void {
    const { heap, address } = this.world;
    heap.check(call(heap.f, address, heap.input, heap));
  }
}
