// The bodies of a world as instances: one mesh for each form, filled anew in every frame.
import * as three from "three";
import * as c from "../../web/src/declarations.js";
import { Body } from "../../web/src/body.js";
import { type OutlinePart, outlineOf } from "../../web/src/outline.js";
import type { World } from "../../web/src/world.js";
import { STRIDE, State } from "./engine.js";
import { SOFTWARE } from "./software.js";

/** A part of a body: the form that it shares with others, and its place in the body. */
interface Part {
  form: string;
  local: three.Matrix4;
}

/** Chooses the colour of a body by its row of the list `bodies`. */
export type Painter = (row: number, state: number, island: number, out: three.Color) => void;

const FLOOR_SIZE = 400;
const FIRST_ROOM = 16;
// Facets of round forms: around, and from pole to pole. A processor pays for each corner twice, in the picture and in the shadow.
const [AROUND, ALONG] = SOFTWARE ? [12, 8] : [24, 14];
const [COARSE_AROUND, COARSE_ALONG] = [8, 6];
const MANY = 100; // of one form: a processor draws them coarse

function unitGeometry(form: string, around: number, along: number): three.BufferGeometry {
  switch (form) {
    case formOf(c.LKS_SPHERE): return new three.SphereGeometry(1, around, along);
    case formOf(c.LKS_BOX): return new three.BoxGeometry(2, 2, 2);
    case formOf(c.LKS_CYLINDER): return new three.CylinderGeometry(1, 1, 2, around);
    case formOf(c.LKS_CONE): return new three.ConeGeometry(1, 1, around).translate(0, 0.25, 0);
    case CAP: return new three.SphereGeometry(1, around, along / 2, 0, 2 * Math.PI, 0, Math.PI / 2);
    case TUBE: return new three.CylinderGeometry(1, 1, 2, around, 1, true);
    default: return new three.PlaneGeometry(FLOOR_SIZE, FLOOR_SIZE).rotateX(-Math.PI / 2);
  }
}

function material(roughness: number, look: three.MeshLambertMaterialParameters): three.MeshLambertMaterial | three.MeshStandardMaterial {
  return SOFTWARE ? new three.MeshLambertMaterial(look) : new three.MeshStandardMaterial({ ...look, roughness });
}

/** The hull of two balls, its centre of mass at the origin: `tapered_ends.cpp` has the formula. */
function taperedGeometry(a: number, height: number, b: number): three.BufferGeometry {
  if (Math.abs(a - b) >= height) return new three.SphereGeometry(Math.max(a, b), AROUND, ALONG);
  const slope = (a - b) / height;
  const centre = (height * (1 - slope) ** 2 * (height * (a * a + 2 * a * b + 3 * b * b) + (2 + slope) * (a + b) * (a * a + b * b)))
    / (4 * (height * (a * a + a * b + b * b) * (1 + slope * slope) + 2 * (a ** 3 + b ** 3)));
  const tangent = Math.asin(slope), arcSteps = ALONG / 2;
  const outline: three.Vector2[] = [];
  const addArc = (radius: number, y: number, from: number, to: number): void => {
    for (let i = 0; i <= arcSteps; ++i) {
      const angle = from + (to - from) * i / arcSteps;
      outline.push(new three.Vector2(Math.max(0, radius * Math.cos(angle)), y + radius * Math.sin(angle)));
    }
  };
  addArc(a, -centre, -Math.PI / 2, tangent);
  addArc(b, height - centre, tangent, Math.PI / 2);
  return new three.LatheGeometry(outline, AROUND);
}

/** The form of all bodies of a kind, whatever their size. */
function formOf(kind: number): string {
  return `form ${kind}`;
}
const CAP = "form cap", TUBE = "form tube"; // of capsules

/** Whether nobody outside sees the inner side of its faces: they are not drawn then. */
function isClosed(form: string): boolean {
  return form.startsWith("form");
}

/** Meshes of one form; solid or transparent. */
class Batch {
  mesh: three.InstancedMesh;
  private count = 0;

  /** `coarse`: for many of them. */
  constructor(private readonly group: three.Group, private readonly geometry: three.BufferGeometry, private readonly coarse: three.BufferGeometry,
    private readonly material: three.Material, private readonly shadow: boolean) {
    this.mesh = this.make(geometry, FIRST_ROOM);
  }

  begin(): void {
    this.count = 0;
  }

  add(matrix: three.Matrix4, color: three.Color): void {
    if (this.count === this.mesh.instanceMatrix.count) this.grow();
    this.mesh.setMatrixAt(this.count, matrix);
    this.mesh.setColorAt(this.count++, color);
  }

  finish(): void {
    this.mesh.count = this.count;
    this.mesh.geometry = this.count > MANY ? this.coarse : this.geometry;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.group.remove(this.mesh);
    this.geometry.dispose();
    this.coarse.dispose();
    this.mesh.dispose();
  }

  private make(geometry: three.BufferGeometry, room: number): three.InstancedMesh {
    const mesh = new three.InstancedMesh(geometry, this.material, room);
    mesh.frustumCulled = false;
    mesh.castShadow = this.shadow;
    mesh.receiveShadow = true;
    this.group.add(mesh);
    return mesh;
  }

  private grow(): void {
    const { mesh } = this;
    this.group.remove(mesh);
    this.mesh = this.make(mesh.geometry, 2 * mesh.instanceMatrix.count);
    this.mesh.instanceMatrix.array.set(mesh.instanceMatrix.array);
    this.mesh.setColorAt(0, new three.Color());
    if (mesh.instanceColor) this.mesh.instanceColor!.array.set(mesh.instanceColor.array);
    mesh.dispose();
  }
}

export class Bodies {
  readonly group = new three.Group();
  private readonly batches = new Map<string, Batch>();
  private readonly outlines = new Map<string, Part[]>();
  private readonly geometries = new Map<string, three.BufferGeometry>();
  private readonly solid = material(0.75, { flatShading: true, shadowSide: three.FrontSide }); // inner sides would leave a gap at the ground
  /** Of forms that may be seen from both sides. */
  private readonly sheet = material(0.75, { flatShading: true, side: three.DoubleSide });
  private readonly clear = material(0.9, { transparent: true, opacity: 0.25, depthWrite: false });
  readonly floor = material(1, {});

  constructor() {
    const grid = gridTexture();
    grid.repeat.set(FLOOR_SIZE / 2, FLOOR_SIZE / 2);
    this.floor.map = grid;
  }

  /**
   * Fills all meshes. `list` is the list `bodies` of the world. Returns whether it knew all outlines. If not it has read them, which takes memory; that may have
   * grown, and arrays of the engine are empty then: the caller asks for them again, and calls this again.
   */
  update(world: World, ids: BigUint64Array, list: Float32Array, positions: Float32Array, orientations: Float32Array, paint: Painter): boolean {
    for (const batch of this.batches.values()) batch.begin();
    const unknown: { id: bigint; mark: number }[] = [];
    const color = new three.Color(), pose = new three.Matrix4(), whole = new three.Matrix4();
    const place = new three.Vector3(), turn = new three.Quaternion(), one = new three.Vector3(1, 1, 1);
    for (let at = 0; at < list.length; at += STRIDE.bodies) {
      const [row, state, island, mark] = [list[at]!, list[at + 1]!, list[at + 2]!, list[at + 3]!];
      if (!ids[row]) continue;
      const parts = this.outlines.get(outlineKey(ids[row]!, mark));
      if (!parts) {
        unknown.push({ id: ids[row]!, mark });
        continue;
      }
      place.fromArray(positions, 3 * row);
      turn.fromArray(orientations, 4 * row);
      pose.compose(place, turn, one);
      paint(row, state, island, color);
      for (const { form, local } of parts) this.batch(form, state).add(whole.multiplyMatrices(pose, local), color);
    }
    for (const batch of this.batches.values()) batch.finish();
    for (const { id, mark } of unknown) this.read(world, id, mark);
    return unknown.length === 0;
  }

  /** How many meshes the last update filled. */
  get count(): number {
    let sum = 0;
    for (const { mesh } of this.batches.values()) sum += mesh.count;
    return sum;
  }

  dispose(): void {
    for (const batch of this.batches.values()) batch.dispose();
  }

  private batch(form: string, state: number): Batch {
    const kind = form.startsWith("floor") ? "floor" : state === State.trigger ? "clear" : state === State.fixed ? "fixed" : "solid";
    const key = `${kind} ${form}`;
    let batch = this.batches.get(key);
    if (!batch) {
      const material = kind === "floor" ? this.floor : kind === "clear" ? this.clear : isClosed(form) ? this.solid : this.sheet;
      const geometry = this.geometries.get(form)!;
      const coarse = SOFTWARE && isClosed(form) ? unitGeometry(form, COARSE_AROUND, COARSE_ALONG) : geometry;
      batch = new Batch(this.group, geometry, coarse, material, kind === "solid" || kind === "fixed");
      this.batches.set(key, batch);
    }
    return batch;
  }

  private read(world: World, id: bigint, mark: number): void {
    const outline = outlineOf(new Body(world, id));
    const parts = outline.parts.flatMap((part) => (part.kind === c.LKS_CAPSULE ? this.capsuleOf(part) : [this.partOf(part)]));
    if (outline.triangles.length > 0) parts.push(this.trianglesOf(outline.triangles, mark));
    this.outlines.set(outlineKey(id, mark), parts);
  }

  // Of a tube and two caps, the same for capsules of all sizes: a form of its own for each would be drawn by itself.
  private capsuleOf({ size, place, axes }: OutlinePart): Part[] {
    const [radius = 1, half = 1] = size;
    const [x, y, z] = [0, 3, 6].map((i) => new three.Vector3().fromArray(axes, i)), centre = new three.Vector3().fromArray(place);
    for (const form of [CAP, TUBE]) this.make(form, () => unitGeometry(form, AROUND, ALONG));
    const part = (form: string, side: number, along: number, shift: number): Part => {
      const [a, b, d] = [x!.clone().multiplyScalar(radius), y!.clone().multiplyScalar(side * along), z!.clone().multiplyScalar(side * radius)];
      return { form, local: new three.Matrix4().makeBasis(a, b, d).setPosition(centre.clone().addScaledVector(y!, shift)) };
    };
    return [part(TUBE, 1, half, 0), part(CAP, 1, radius, half), part(CAP, -1, radius, -half)];
  }

  private make(form: string, geometry: () => three.BufferGeometry): void {
    if (!this.geometries.has(form)) this.geometries.set(form, geometry());
  }

  private partOf({ kind, size, place, axes }: OutlinePart): Part {
    const [x = 1, y = 1, z = 1] = size;
    const form = kind === c.LKS_TAPERED_CAPSULE ? `tapered ${x} ${y} ${z}` : kind === c.LKS_HALF_SPACE ? "floor" : formOf(kind);
    this.make(form, () => (kind === c.LKS_TAPERED_CAPSULE ? taperedGeometry(x, y, z) : unitGeometry(form, AROUND, ALONG)));
    const scale = kind === c.LKS_SPHERE ? [x, x, x] : kind === c.LKS_BOX ? [x, y, z]
      : kind === c.LKS_CYLINDER || kind === c.LKS_CONE ? [x, y, x] : [1, 1, 1];
    const [a, b, d] = [0, 3, 6].map((i, k) => new three.Vector3().fromArray(axes, i).multiplyScalar(scale[k]!));
    const local = new three.Matrix4().makeBasis(a!, b!, d!).setPosition(place[0]!, place[1]!, place[2]!);
    return { form, local };
  }

  private trianglesOf(triangles: Float32Array, mark: number): Part {
    const form = `triangles ${mark} ${triangles.length}`;
    this.make(form, () => {
      const geometry = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(triangles, 3));
      geometry.computeVertexNormals();
      return geometry;
    });
    return { form, local: new three.Matrix4() };
  }
}

// A body keeps its outline as long as its shape has this mark.
function outlineKey(id: bigint, mark: number): string {
  return `${id} ${mark}`;
}

function gridTexture(): three.Texture {
  const size = 128;
  const canvas = Object.assign(document.createElement("canvas"), { width: size, height: size });
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, size, size);
  pen.strokeStyle = "#d4d9df";
  pen.lineWidth = 2;
  pen.strokeRect(0, 0, size, size);
  pen.strokeStyle = "#eceff2";
  pen.strokeRect(size / 2, 0, 0.1, size);
  pen.strokeRect(0, size / 2, size, 0.1);
  const texture = new three.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = three.RepeatWrapping;
  texture.anisotropy = SOFTWARE ? 1 : 8;
  texture.colorSpace = three.SRGBColorSpace;
  return texture;
}
