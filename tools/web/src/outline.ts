import type { Body } from "./body.js";
import { LKS_BUFFER_TOO_SMALL, lks_web_part } from "./declarations.js";

/** A part of a body's shape, in the frame of the shape, in floating point to be drawn. */
export interface OutlinePart {
  /** LKS_SPHERE (0), LKS_CAPSULE (1), LKS_BOX (2), LKS_HALF_SPACE (4), LKS_CYLINDER (8), LKS_CONE (9), LKS_TAPERED_CAPSULE (10) of the C
   *  interface. */
  kind: number;
  /** As of `Shape`. */
  size: Float32Array;
  place: Float32Array;
  /** The unit vectors of its axes, one after another. */
  axes: Float32Array;
}

/** The shape of a body, to be drawn: parts with a form, and the triangles of its hulls and meshes. */
export interface Outline {
  parts: OutlinePart[];
  /** Nine numbers a triangle, counter-clockwise seen from outside. */
  triangles: Float32Array;
}

/** The shape of a body as floating-point copies: ask once for each body, and place it by a `View`. */
export function outlineOf(body: Body, partRoom = 16, triangleRoom = 256): Outline {
  const { heap, address } = body.world;
  const parts = heap.allocate(partRoom * lks_web_part.$bytes);
  const triangles = heap.allocate(triangleRoom * 36);
  try {
    const [partCount, triangleCount] = [heap.output, heap.output + 8];
    const status = heap.f.lks_web_outline(address, body.id, parts, partRoom, partCount, triangles, triangleRoom, triangleCount);
    const [m, n] = [heap.getWord(partCount), heap.getWord(triangleCount)];
    if (status === LKS_BUFFER_TOO_SMALL && (m > partRoom || n > triangleRoom)) return outlineOf(body, m, n);
    heap.check(status);
    const floats = (at: number, count: number) => heap.f32.slice(at >>> 2, (at >>> 2) + count);
    return {
      parts: Array.from({ length: m }, (_, i) => {
        const at = parts + i * lks_web_part.$bytes;
        return {
          kind: heap.getWord(at + lks_web_part.kind), size: floats(at + lks_web_part.size, 3),
          place: floats(at + lks_web_part.place, 3), axes: floats(at + lks_web_part.axes, 9),
        };
      }),
      triangles: floats(triangles, 9 * n),
    };
  } finally {
    heap.f.free(triangles);
    heap.f.free(parts);
  }
}
