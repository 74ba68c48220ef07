// Lines and points over the bodies: what the physics knows and a picture of bodies does not show.
import * as three from "three";
import { type Lists, STRIDE } from "./engine.js";

export const OVERLAYS = ["contacts", "joints", "bounds", "masses"] as const;
export type Overlay = (typeof OVERLAYS)[number];

const POINT = new three.Color(0xff3b6b), FORCE = new three.Color(0xffb020), JOINT = new three.Color(0x22c1ee);
const BOUNDS = new three.Color(0x9b7bff), AXES = [0xff4d4d, 0x37c871, 0x4d8dff].map((hex) => new three.Color(hex));
// The corners of a box by bits of axes, and its edges.
const EDGES = [0, 1, 0, 2, 0, 4, 1, 3, 1, 5, 2, 3, 2, 6, 3, 7, 4, 5, 4, 6, 5, 7, 6, 7];

/** A place that is pointed at from above. */
export interface Pin {
  place: ArrayLike<number>;
  color: three.Color;
}

/** Growing arrays of coloured vertices. */
class Vertices {
  readonly geometry = new three.BufferGeometry();
  private places: number[] = [];
  private colors: number[] = [];

  add(x: number, y: number, z: number, color: three.Color): void {
    this.places.push(x, y, z);
    this.colors.push(color.r, color.g, color.b);
  }

  flush(): void {
    this.set("position", this.places);
    this.set("color", this.colors);
    this.geometry.setDrawRange(0, this.places.length / 3);
    this.places = [];
    this.colors = [];
  }

  private set(name: string, from: number[]): void {
    const old = this.geometry.getAttribute(name) as three.BufferAttribute | undefined;
    if (old && old.array.length >= from.length) {
      old.array.set(from);
      old.needsUpdate = true;
    } else {
      const room = new Float32Array(Math.max(3 * 256, 2 * from.length));
      room.set(from);
      this.geometry.setAttribute(name, new three.BufferAttribute(room, 3));
    }
  }
}

export class Overlays {
  readonly group = new three.Group();
  private readonly lines = new Vertices();
  private readonly points = new Vertices();

  constructor() {
    const look = { vertexColors: true, depthTest: false, transparent: true };
    const lines = new three.LineSegments(this.lines.geometry, new three.LineBasicMaterial(look));
    const points = new three.Points(this.points.geometry, new three.PointsMaterial({ ...look, size: 7, sizeAttenuation: false }));
    for (const object of [lines, points]) {
      object.frustumCulled = false;
      object.renderOrder = 10;
      this.group.add(object);
    }
  }

  /** Lists that were not drawn are empty. `size`: m, of marks. `pulled`: from the body to the hand. */
  update(lists: Lists, size: number, pulled: three.Vector3[] | null, pins: readonly Pin[]): void {
    this.addContacts(lists.contacts, size);
    this.addJoints(lists.joints);
    this.addBounds(lists.bounds);
    this.addMasses(lists.masses, size);
    if (pulled) this.line(pulled[0]!.toArray(), pulled[1]!.toArray(), FORCE);
    for (const { place, color } of pins) {
      const [x, y, z] = [place[0]!, place[1]!, place[2]!];
      this.line([x, y, z], [x, y + 8 * size, z], color);
      this.points.add(x, y + 8 * size, z, color);
    }
    this.lines.flush();
    this.points.flush();
  }

  private line(a: ArrayLike<number>, b: ArrayLike<number>, color: three.Color): void {
    this.lines.add(a[0]!, a[1]!, a[2]!, color);
    this.lines.add(b[0]!, b[1]!, b[2]!, color);
  }

  // A point, and along the normal a line as long as the force is large, by its square root.
  private addContacts(list: Float32Array, size: number): void {
    let most = 0;
    for (let at = 0; at < list.length; at += STRIDE.contacts) most = Math.max(most, list[at + 8]!);
    for (let at = 0; at < list.length; at += STRIDE.contacts) {
      const [x, y, z] = [list[at + 2]!, list[at + 3]!, list[at + 4]!];
      this.points.add(x, y, z, POINT);
      const long = most > 0 ? 2.5 * size * Math.sqrt(list[at + 8]! / most) : 0;
      this.line([x, y, z], [x + long * list[at + 5]!, y + long * list[at + 6]!, z + long * list[at + 7]!], FORCE);
    }
  }

  private addJoints(list: Float32Array): void {
    for (let at = 0; at < list.length; at += STRIDE.joints) {
      const [a, b] = [list.subarray(at + 4, at + 7), list.subarray(at + 7, at + 10)];
      this.line(a, b, JOINT);
      for (const end of [a, b]) this.points.add(end[0]!, end[1]!, end[2]!, JOINT);
    }
  }

  private addBounds(list: Float32Array): void {
    for (let at = 0; at < list.length; at += STRIDE.bounds) {
      if (list[at + 4]! - list[at + 1]! > 1000) continue; // a half-space has no end
      for (const corner of EDGES) {
        const along = (axis: number) => list[at + 1 + axis + ((corner >> axis) & 1 ? 3 : 0)]!;
        this.lines.add(along(0), along(1), along(2), BOUNDS);
      }
    }
  }

  private addMasses(list: Float32Array, size: number): void {
    for (let at = 0; at < list.length; at += STRIDE.masses) {
      const [x, y, z] = [list[at + 1]!, list[at + 2]!, list[at + 3]!];
      AXES.forEach((color, i) => {
        const axis = [0, 1, 2].map((k) => size * list[at + 4 + 3 * i + k]!);
        this.line([x, y, z], [x + axis[0]!, y + axis[1]!, z + axis[2]!], color);
      });
    }
  }
}
