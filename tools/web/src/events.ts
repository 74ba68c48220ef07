import { Body } from "./body.js";
import * as c from "./declarations.js";
import { list, listAll } from "./list.js";
import type { Numbers3 } from "./units.js";
import type { World } from "./world.js";

export const EventKind = {
  contactBegin: c.LKS_CONTACT_BEGIN,
  contactEnd: c.LKS_CONTACT_END,
  triggerEnter: c.LKS_TRIGGER_ENTER,
  triggerStay: c.LKS_TRIGGER_STAY,
  triggerExit: c.LKS_TRIGGER_EXIT,
  /** `a` was stopped on its way by `b` within the tick. */
  impact: c.LKS_IMPACT,
  sleep: c.LKS_SLEEP,
  wake: c.LKS_WAKE,
  /** The two touch, as a tick ago; of bodies that ask for it (`persistEvents`). */
  contactPersist: c.LKS_CONTACT_PERSIST,
} as const;

export interface WorldEvent {
  /** One of `EventKind`. */
  kind: number;
  a: Body;
  /** null of sleep and wake. */
  b: Body | null;
  /** m/s, of contact begin and impact. */
  approachSpeed: number;
  /** Of the surfaces where they meet. */
  tagA: number;
  tagB: number;
}

/** Events of the last step: contacts and triggers by pair, then impacts, then sleep and wake. Read them before the next step. */
export function events(world: World): WorldEvent[] {
  const { heap } = world;
  const event = c.lks_event;
  return list(heap, event.$bytes, (...to) => heap.f.lks_events(world.address, ...to), (at) => {
    const b = heap.getId(at + event.b);
    return {
      kind: heap.getWord(at + event.kind),
      a: new Body(world, heap.getId(at + event.a)),
      b: b === 0n ? null : new Body(world, b),
      approachSpeed: heap.get64(at + event.approach_speed, c.LKS_VELOCITY_BITS),
      tagA: heap.getWord(at + event.tag_a),
      tagB: heap.getWord(at + event.tag_b),
    };
  });
}

/** Two bodies came together faster than the hit speed of one of them, and pushed each other. */
export interface HitEvent {
  a: Body;
  b: Body;
  /** m, mean of the contact's points, weighted by their impulses. */
  point: Numbers3;
  /** From a to b. */
  normal: Numbers3;
  /** N·s of the tick, at all points. */
  normalImpulse: number;
  /** N·s of the tick, on b. */
  frictionImpulse: Numbers3;
  /** m/s. */
  approachSpeed: number;
  /** As of `EventKind.impact`. */
  wasStopped: boolean;
  /** Triangle, cell or child where they meet. */
  partA: number;
  partB: number;
  tagA: number;
  tagB: number;
}

/** Hits of the last step. */
export function hitEvents(world: World): HitEvent[] {
  const { heap } = world;
  const hit = c.lks_hit_event;
  return list(heap, hit.$bytes, (...to) => heap.f.lks_hit_events(world.address, ...to), (at) => ({
    a: new Body(world, heap.getId(at + hit.a)),
    b: new Body(world, heap.getId(at + hit.b)),
    point: heap.getVector64(at + hit.point, c.LKS_POSITION_BITS),
    normal: heap.getVector32(at + hit.normal, c.LKS_UNIT_BITS),
    normalImpulse: heap.get64(at + hit.normal_impulse, c.LKS_IMPULSE_BITS),
    frictionImpulse: heap.getVector64(at + hit.friction_impulse, c.LKS_IMPULSE_BITS),
    approachSpeed: heap.get64(at + hit.approach_speed, c.LKS_VELOCITY_BITS),
    wasStopped: heap.getWord(at + hit.was_stopped) === 1,
    partA: heap.getWord(at + hit.part_a),
    partB: heap.getWord(at + hit.part_b),
    tagA: heap.getWord(at + hit.tag_a),
    tagB: heap.getWord(at + hit.tag_b),
  }));
}

/** A contact of a body with another, as the last step left it. */
export interface BodyContact {
  other: Body;
  /** m, in the middle between both surfaces; N; m, negative when overlapping. */
  points: { point: Numbers3; normalForce: number; separation: number }[];
  /** N: pushes the other along the normal, at all points. */
  normalForce: number;
  /** N, on the other. */
  friction: Numbers3;
  /** From the body to the other. */
  normal: Numbers3;
  part: number;
  otherPart: number;
  tag: number;
  otherTag: number;
}

/** The contacts in which a body touches others, by the other's index. */
export function contactsOf(body: Body): BodyContact[] {
  const { world } = body;
  const { heap } = world;
  const contact = c.lks_body_contact;
  const spot = c.lks_touching_point;
  const pointAt = (at: number) => ({
    point: heap.getVector64(at + spot.point, c.LKS_POSITION_BITS),
    normalForce: heap.get64(at + spot.normal_force, c.LKS_FORCE_BITS),
    separation: heap.get32(at + spot.separation, c.LKS_DISPLACEMENT_BITS),
  });
  return listAll(heap, contact.$bytes, (...to) => heap.f.lks_contacts_of(world.address, body.id, ...to), (at) => ({
    other: new Body(world, heap.getId(at + contact.other)),
    points: Array.from({ length: heap.getWord(at + contact.count) },
      (_, i) => pointAt(at + contact.points + i * spot.$bytes)),
    normalForce: heap.get64(at + contact.normal_force, c.LKS_FORCE_BITS),
    friction: heap.getVector64(at + contact.friction, c.LKS_FORCE_BITS),
    normal: heap.getVector32(at + contact.normal, c.LKS_UNIT_BITS),
    part: heap.getWord(at + contact.part),
    otherPart: heap.getWord(at + contact.other_part),
    tag: heap.getWord(at + contact.tag),
    otherTag: heap.getWord(at + contact.other_tag),
  }));
}

/** Whether two bodies touch as of the last step. */
export function touching(a: Body, b: Body): boolean {
  const { heap, address } = a.world;
  heap.check(heap.f.lks_touching(address, a.id, b.id, heap.output));
  return heap.getWord(heap.output) === 1;
}
