import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import type { Lockstone } from "./load.js";
import { type Quantity, type Vector, raw32 } from "./units.js";

/** A shape, made by `sphere`, `box`, …. Sizes are 0.98 mm … 512 m. */
export interface Shape {
  readonly kind: number;
  readonly size: Vector;
  /** The name of an asset; the raw radius of a rounded box; 0 of others. */
  readonly asset: bigint;
}

function shape(kind: number, x: Quantity = 0, y: Quantity = 0, z: Quantity = 0, asset = 0n): Shape {
  return { kind, size: [x, y, z], asset };
}

export function sphere(radius: Quantity): Shape {
  return shape(c.LKS_SPHERE, radius);
}

/** Along y; the half height is that of the core segment. */
export function capsule(halfHeight: Quantity, radius: Quantity): Shape {
  return shape(c.LKS_CAPSULE, radius, halfHeight);
}

export function box(halfX: Quantity, halfY: Quantity, halfZ: Quantity): Shape {
  return shape(c.LKS_BOX, halfX, halfY, halfZ);
}

/** Along y. */
export function cylinder(halfHeight: Quantity, radius: Quantity): Shape {
  return shape(c.LKS_CYLINDER, radius, halfHeight);
}

/** Along y, the apex up; its base is a quarter of the height below the centre of mass. */
export function cone(height: Quantity, radius: Quantity): Shape {
  return shape(c.LKS_CONE, radius, height);
}

/** The hull of two balls along y, whose centres are the height apart. Needs the module of `loadFull`. */
export function taperedCapsule(height: Quantity, bottomRadius: Quantity, topRadius: Quantity): Shape {
  return shape(c.LKS_TAPERED_CAPSULE, bottomRadius, height, topRadius);
}

/** A box of these half extents, and all within the radius of it. Needs the module of `loadFull`. */
export function roundedBox(halfX: Quantity, halfY: Quantity, halfZ: Quantity, radius: Quantity): Shape {
  return shape(c.LKS_ROUNDED_BOX, halfX, halfY, halfZ, BigInt(raw32(radius, c.LKS_LENGTH_BITS)));
}

/** All below the plane y = 0 of its body, which must be static. */
export function halfSpace(): Shape {
  return shape(c.LKS_HALF_SPACE);
}

/** A hull, mesh, height field or compound of the world's assets. */
export function assetShape(kind: "hull" | "mesh" | "heightField" | "compound", asset: bigint): Shape {
  const kinds = { hull: c.LKS_HULL, mesh: c.LKS_MESH, heightField: c.LKS_HEIGHT_FIELD, compound: c.LKS_COMPOUND };
  return shape(kinds[kind], 0, 0, 0, asset);
}

export function putShape(heap: Heap, address: number, { kind, size, asset }: Shape): void {
  heap.putWord(address + c.lks_shape.kind, kind);
  heap.putVector32(address + c.lks_shape.size, size, c.LKS_LENGTH_BITS);
  heap.u64[(address + c.lks_shape.asset) >>> 3] = asset;
}

export function getShape(heap: Heap, address: number): Shape {
  return {
    kind: heap.getWord(address + c.lks_shape.kind),
    size: heap.getVector32(address + c.lks_shape.size, c.LKS_LENGTH_BITS),
    asset: heap.getId(address + c.lks_shape.asset),
  };
}

const forgotten = new FinalizationRegistry<() => void>((free) => free());

/** Geometry that worlds are made with. Every peer needs the same set. Needs the module of `loadFull`. */
export class Assets {
  readonly address: number;

  constructor(private readonly lockstone: Lockstone) {
    const { heap } = lockstone;
    heap.needs("lks_assets_create");
    heap.check(heap.f.lks_assets_create(heap.output));
    const address = (this.address = heap.getWord(heap.output));
    forgotten.register(this, () => heap.f.lks_assets_destroy(address));
  }

  /** The convex hull of 4 … 65536 points; with a radius, all points within it of that hull. */
  addHull(points: readonly Vector[], maxVertices = 64, radius: Quantity = 0): Shape {
    const { heap } = this.lockstone;
    const bytes = points.length * c.lks_i32x3.$bytes;
    const asset = this.add(bytes, (at) => {
      points.forEach((point, i) => heap.putVector32(at + i * c.lks_i32x3.$bytes, point, c.LKS_LENGTH_BITS));
      return heap.f.lks_assets_add_rounded_hull(this.address, at, points.length, maxVertices, raw32(radius, c.LKS_LENGTH_BITS),
        heap.output);
    });
    return assetShape("hull", asset);
  }

  /**
   * A path for path joints: a smooth curve through 2 … 4096 points, each with the direction up there (y unless
   * given) and with the angle in radians by which the track leans to the right (0 unless given); its name.
   */
  addPath(points: readonly { position: Vector; up?: Vector; bank?: number }[], closed = false): bigint {
    const { heap } = this.lockstone;
    const { $bytes, position, up } = c.lks_path_point;
    const banks = points.length * $bytes;
    return this.add(banks + points.length * 4, (room) => {
      points.forEach((point, i) => {
        heap.putVector32(room + i * $bytes + position, point.position, c.LKS_LENGTH_BITS);
        heap.putVector32(room + i * $bytes + up, point.up ?? [0, 1, 0], c.LKS_UNIT_BITS);
        heap.put32(room + banks + i * 4, point.bank ?? 0, c.LKS_ANGLE_BITS);
      });
      return heap.f.lks_assets_add_banked_path(
        this.address, room, room + banks, points.length, closed ? 1 : 0, heap.output);
    });
  }

  /** A hull, mesh or height field of the set scaled along its axes: built once, rounded to 2^-20 m. Negative factors mirror. */
  addScaled(shape: Shape, factors: Vector): Shape {
    const { heap } = this.lockstone;
    const asset = this.add(c.lks_i32x3.$bytes, (at) => {
      heap.putVector32(at, factors, c.LKS_NUMBER_BITS);
      return heap.f.lks_assets_add_scaled(this.address, shape.asset, at, heap.output);
    });
    return { ...shape, asset };
  }

  /** An asset of any kind from its bytes, as `lockstone asset build` writes them; its name, for `assetShape`. */
  addBytes(bytes: Uint8Array): bigint {
    const { heap } = this.lockstone;
    return this.add(bytes.length, (at) => {
      heap.u8.set(bytes, at);
      return heap.f.lks_assets_add_bytes(this.address, at, bytes.length, heap.output);
    });
  }

  /** The child of a compound that a part of an event or query belongs to; of a mesh also the triangle, else 0. */
  findPart(compound: bigint, part: number): { child: number; triangle: number } {
    const { heap } = this.lockstone;
    const at = heap.output;
    heap.check(heap.f.lks_assets_find_part(this.address, compound, part, at, at + 4));
    return { child: heap.getWord(at), triangle: heap.getWord(at + 4) };
  }

  private add(bytes: number, call: (address: number) => number): bigint {
    const { heap } = this.lockstone;
    const room = heap.allocate(bytes);
    try {
      heap.check(call(room));
      return heap.getId(heap.output);
    } finally {
      heap.f.free(room);
    }
  }
}
