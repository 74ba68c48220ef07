/* Shapes, and the geometry that some of them name. */
#ifndef LOCKSTONE_C_ASSETS_H
#define LOCKSTONE_C_ASSETS_H

#include "units.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  LKS_SPHERE = 0,
  LKS_CAPSULE = 1,
  LKS_BOX = 2,
  LKS_HULL = 3,
  LKS_HALF_SPACE = 4, /* all below the plane y = 0 of its body; of static bodies only */
  LKS_MESH = 5,
  LKS_HEIGHT_FIELD = 6,
  LKS_COMPOUND = 7,
  LKS_CYLINDER = 8,
  LKS_CONE = 9,
  LKS_TAPERED_CAPSULE = 10,
  LKS_ROUNDED_BOX = 11
};

/* The size means, by kind: sphere: x = radius; capsule: x = radius, y = half the length of the core
 * segment, along y; box: half extents; cylinder: x = radius, y = half the height, along y; cone: x
 * = radius of the base, y = height, along y, the origin a quarter of it above the base; tapered
 * capsule: the hull of two balls on the y axis, x = radius of the lower one, y = distance of their
 * centres, z = radius of the upper one, the origin at its centre of mass; rounded box: half extents
 * of the box that its radius surrounds, which with the radius are at most 512 m; others: zero.
 * Sizes are 0.98 mm … 512 m; a box with one half extent of 0.98 mm or more may have others from 0.1
 * mm. */
typedef struct lks_shape {
  uint32_t kind;
  lks_length3 size;
  uint64_t asset; /* of hull, mesh, height field and compound; a rounded box' radius; else 0 */
} lks_shape;

static inline lks_shape lks_shape_of(uint32_t kind, lks_length x, lks_length y, lks_length z,
                                     uint64_t asset) {
  lks_shape shape;
  shape.kind = kind;
  shape.size.x = x;
  shape.size.y = y;
  shape.size.z = z;
  shape.asset = asset;
  return shape;
}
static inline lks_shape lks_sphere(lks_length radius) {
  return lks_shape_of(LKS_SPHERE, radius, 0, 0, 0);
}
static inline lks_shape lks_capsule(lks_length half_height, lks_length radius) {
  return lks_shape_of(LKS_CAPSULE, radius, half_height, 0, 0);
}
static inline lks_shape lks_box(lks_length half_x, lks_length half_y, lks_length half_z) {
  return lks_shape_of(LKS_BOX, half_x, half_y, half_z, 0);
}
static inline lks_shape lks_cylinder(lks_length half_height, lks_length radius) {
  return lks_shape_of(LKS_CYLINDER, radius, half_height, 0, 0);
}
static inline lks_shape lks_cone(lks_length height, lks_length radius) {
  return lks_shape_of(LKS_CONE, radius, height, 0, 0);
}
static inline lks_shape lks_tapered_capsule(lks_length height, lks_length bottom_radius,
                                            lks_length top_radius) {
  return lks_shape_of(LKS_TAPERED_CAPSULE, bottom_radius, height, top_radius, 0);
}
/* A box of these half extents, and all within `radius` of it: `asset` holds the radius. */
static inline lks_shape lks_rounded_box(lks_length half_x, lks_length half_y, lks_length half_z,
                                        lks_length radius) {
  return lks_shape_of(LKS_ROUNDED_BOX, half_x, half_y, half_z, (uint64_t)(uint32_t)radius);
}
static inline lks_shape lks_half_space(void) {
  return lks_shape_of(LKS_HALF_SPACE, 0, 0, 0, 0);
}
static inline lks_shape lks_hull(uint64_t asset) {
  return lks_shape_of(LKS_HULL, 0, 0, 0, asset);
}

/* A sphere, box or capsule (`kind`) about 1 … 65536 points within ±512 m, and its frame in that of
 * the points: all of them lie inside, or outside by at most 8 µm. LKS_INVALID_ARGUMENT for another
 * kind, and where the shape would be too large. */
LKS_API lks_status lks_fit(uint32_t kind, const lks_length3* points, size_t count, lks_shape* shape,
                           lks_pose* pose);

/* A set of assets, to be filled before worlds are made with it. Every peer needs the same set. */
typedef struct lks_assets lks_assets;

LKS_API lks_status lks_assets_create(lks_assets** out);

/* Worlds made with the set keep the assets that they use. Null is allowed. */
LKS_API void lks_assets_destroy(lks_assets* assets);

/* Adds the convex hull of 4 … 65536 points within ±512 m; `out` is its name: a hash of its content.
 * max_vertices 4 … 128, as a rule 64. LKS_INVALID_ARGUMENT when the points hold no volume. */
LKS_API lks_status lks_assets_add_hull(lks_assets* assets, const lks_length3* points, size_t count,
                                       int32_t max_vertices, uint64_t* out);

/* A point that a path goes through, within ±512 m, and which way is up there. */
typedef struct lks_path_point {
  lks_length3 position;
  lks_unit3 up; /* any length but 0, not along the path */
} lks_path_point;

/* Adds a path for path joints: a smooth curve through 2 … 4096 points, 3 or more of a closed one,
 * each 1/32 … 128 m from the next one; `out` is its name. LKS_INVALID_ARGUMENT says why there is no
 * such path. */
LKS_API lks_status lks_assets_add_path(lks_assets* assets, const lks_path_point* points,
                                       size_t count, uint32_t closed, uint64_t* out);
/* The same track, banked: at each point its frame is turned about the direction of the path, to the
 * right side as one looks along it, by an angle: `banks` has `count` of them. */
LKS_API lks_status lks_assets_add_banked_path(lks_assets* assets, const lks_path_point* points,
                                              const lks_angle* banks, size_t count, uint32_t closed,
                                              uint64_t* out);
/* Of lks_assets_add_hull, with a radius, 0.98 mm … 512 m: all points within it of that hull. */
LKS_API lks_status lks_assets_add_rounded_hull(lks_assets* assets, const lks_length3* points,
                                               size_t count, int32_t max_vertices,
                                               lks_length radius, uint64_t* out);

/* Adds an asset of any kind from its canonical bytes, as `lockstone asset build` writes them. They
 * may come from anywhere. A compound's hulls and meshes must be in the set: else LKS_NOT_FOUND. */
LKS_API lks_status lks_assets_add_bytes(lks_assets* assets, const void* bytes, size_t count,
                                        uint64_t* out);

/* The child of a compound that a part of an event or query belongs to, and of a mesh the number
 * that the triangle has as a part of that mesh, else 0. Convex children are parts by their own
 * numbers, triangles from 256 on. LKS_NOT_FOUND when the set has no such compound, or the compound
 * no such part. */
LKS_API lks_status lks_assets_find_part(const lks_assets* assets, uint64_t compound, uint32_t part,
                                        uint32_t* child, uint32_t* triangle);

/* Adds a hull, mesh or height field of the set scaled along its axes: each coordinate times the
 * factor of its axis, rounded to the nearest step. No factor is 0; a negative one mirrors, and
 * fronts of triangles stay fronts; those of a height field are above 0, and those of a hull with a
 * radius of one size, which scales the radius too. With all factors 1, `out` is `asset`.
 * LKS_NOT_FOUND for an asset that is not in the set; LKS_INVALID_ARGUMENT for one of another kind,
 * and says why there is no such copy. */
LKS_API lks_status lks_assets_add_scaled(lks_assets* assets, uint64_t asset,
                                         const lks_number3* factors, uint64_t* out);

/* Two shapes without a world. A call takes their assets from the set, which may be null where no
 * shape names one. LKS_INVALID_ARGUMENT for a shape or place out of range, for frames more than
 * 1000 m apart along an axis (the plane of a half-space as far), and for a pair that the function
 * does not take; LKS_NOT_FOUND for an asset that is not in the set. */
typedef struct lks_placed_shape {
  lks_shape shape;
  lks_pose pose; /* of the shape's frame */
} lks_placed_shape;

/* The closest points of A and B. */
typedef struct lks_shape_gap {
  lks_position distance; /* 0 when overlapping */
  lks_position3 point_a; /* on A's surface; zero when overlapping */
  lks_position3 point_b;
  lks_unit3 normal; /* from A to B; zero when overlapping */
  uint32_t part_a;  /* triangle, cell or child */
  uint32_t part_b;
  uint32_t found;       /* 1: the distance is at most `reach`; else all is 0 */
  uint32_t overlapping; /* 1: they share a point */
  uint32_t reserved;    /* 0 */
} lks_shape_gap;

/* `reach` is 0 … 512 m. One of the two at least is a primitive, a hull or a compound without
 * meshes. Error ≤ 2 µm. Of equal distances that of the lowest part of A counts, then of B. */
LKS_API lks_status lks_shape_distance(const lks_assets* assets, const lks_placed_shape* a,
                                      const lks_placed_shape* b, lks_length reach,
                                      lks_shape_gap* out);

/* When A and B meet. */
typedef struct lks_shape_hit {
  lks_position3 point_a; /* on A's surface then */
  lks_unit fraction;     /* of the way, 0 … 1 */
  lks_unit3 normal;      /* from A to B; may be zero when overlapping */
  uint32_t part_a;
  uint32_t part_b;
  uint32_t hit;         /* 0 or 1 */
  uint32_t overlapping; /* 1: at the start; the fraction is 0 */
} lks_shape_hit;

/* Moves B, a primitive or a hull, along `way` (within ±512 m along each axis); A rests. Within 2
 * µm. */
LKS_API lks_status lks_shape_cast(const lks_assets* assets, const lks_placed_shape* a,
                                  const lks_placed_shape* b, const lks_length3* way,
                                  lks_shape_hit* out);

/* Moves both evenly to the poses `end_a` and `end_b` (within ±512 m of their starts along each
 * axis), by the shortest turns, until they are as near as `gap`, 8 µm … 1 m, or 5/4 of it.
 * Primitives, hulls and compounds without meshes. Before the fraction the distance is not below the
 * gap by more than 3 µm and 1e-8 of the sizes. */
LKS_API lks_status lks_shape_impact(const lks_assets* assets, const lks_placed_shape* a,
                                    const lks_pose* end_a, const lks_placed_shape* b,
                                    const lks_pose* end_b, lks_length gap, lks_shape_hit* out);

#ifdef __cplusplus
}
#endif
#endif
