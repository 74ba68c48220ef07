/**
 * Lockstone: deterministic 3D physics in fixed point, the same bits in every browser as on every
 * other machine.
 *
 * @packageDocumentation
 */
export {
  Body, type BodyDef, type BodyView, Combine, type Filter, Lock, Motion, type Surface, type SurfaceMotion,
} from "./body.js";
export { LockstoneError, Status } from "./errors.js";
export {
  type BodyContact, EventKind, type HitEvent, type WorldEvent, contactsOf, events, hitEvents, touching,
} from "./events.js";
export {
  type Axis, AxisMode, Joint, type JointDef, type JointEvent, type JointFrame, JointKind, type JointView, createJoint,
  jointEvents, joints, jointsOf,
} from "./joints.js";
export { type LoadOptions, Lockstone, type WasmSource, hasSimd, load } from "./load.js";
export { type Outline, type OutlinePart, outlineOf } from "./outline.js";
export {
  type Closest, type Hit, type QueryFilter, bodiesInBox, castRay, castRayAll, castShape, closestPoint, isRayBlocked,
  overlapShape, overlapSphere,
} from "./queries.js";
export {
  type Assets, type Shape, box, capsule, cone, cylinder, halfSpace, sphere,
} from "./shapes.js";
export { type PartHashes, Snapshot, loadState, partHashes, saveState } from "./state.js";
export { type Numbers3, type Numbers4, type Quantity, type Rotation, type Vector, hex } from "./units.js";
export { View, type ViewOptions } from "./view.js";
export { type Poses, type StepReport, World, type WorldDef, configHash } from "./world.js";
