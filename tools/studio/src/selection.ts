// The chosen body, in words and numbers.
import { Body, Motion } from "../../web/src/body.js";
import type { World } from "../../web/src/world.js";
import type * as three from "three";
import { Facts, section, toggle } from "./dom.js";

const KINDS = ["sphere", "capsule", "box", "hull", "half-space", "mesh", "height field", "compound", "cylinder", "cone", "tapered capsule", "rounded box"];
const NAMES = ["body", "shape", "motion", "mass", "position", "velocity", "turning", "state"] as const;

function numbers(values: ArrayLike<number>, digits = 4): string {
  return Array.from(values, (x) => x.toFixed(digits)).join("  ");
}

export class Selection {
  readonly facts = new Facts("body", NAMES);
  readonly element: HTMLElement;
  /** The id; 0: none. */
  id = 0n;

  /** `isFollowed`: whether the camera goes along with a chosen body, until the person wants it otherwise. */
  constructor(private isFollowed = false) {
    this.element = section("Body", this.facts.element, toggle("follow", "follow", isFollowed, (on) => (this.isFollowed = on)));
    this.set(0n);
  }

  get row(): number {
    return this.id === 0n ? -1 : Number(this.id & 0xffffffffn);
  }

  set(id: bigint): void {
    this.id = id;
    this.element.hidden = id === 0n;
  }

  /** `target`: of the camera, which follows the body where that is wanted. */
  refresh(world: World, target: three.Vector3): void {
    if (this.id === 0n) return;
    const { facts } = this;
    try {
      const body = new Body(world, this.id);
      const view = body.view;
      if (this.isFollowed) target.set(...view.position);
      const motion = Object.entries(Motion).find(([, value]) => value === view.motion)?.[0] ?? "";
      facts.set("body", `${body.index}`);
      facts.set("shape", KINDS[view.shape.kind] ?? "?");
      facts.set("motion", motion);
      facts.set("mass", view.mass > 0 ? `${view.mass.toPrecision(5)} kg` : "–");
      facts.set("position", `${numbers(view.position)} m`);
      facts.set("velocity", `${numbers(view.velocity)} m/s`);
      facts.set("turning", `${numbers(view.angularVelocity)} rad/s`);
      facts.set("state", view.asleep ? "asleep" : view.trigger ? "trigger" : "awake");
    } catch {
      facts.set("state", "gone at this tick");
    }
  }
}
