/* Questions to a world. They change nothing; several threads may ask at once. */
#ifndef LOCKSTONE_C_QUERIES_H
#define LOCKSTONE_C_QUERIES_H

#include "bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LKS_FILTER_BODIES 16

/* Which bodies a query sees. A null filter sees all but triggers. */
typedef struct lks_query_filter {
  uint32_t size;
  uint32_t mask;        /* categories */
  lks_body ignore;      /* 0: none */
  uint32_t triggers;    /* 1: triggers too */
  uint32_t only_listed; /* 1: the listed bodies alone; 0: all others */
  uint32_t tag_mask;    /* bits of the body's own tag that must be those of `tag`; 0: any tag */
  uint32_t tag;
  uint32_t listed_count; /* 0 … LKS_FILTER_BODIES */
  uint32_t reserved;     /* 0 */
  lks_body listed[LKS_FILTER_BODIES];
} lks_query_filter;

LKS_API lks_status lks_query_filter_init(lks_query_filter* filter, size_t size);

/* Where a ray or a shape on its way first meets a body. */
typedef struct lks_hit {
  lks_body body;     /* 0 when nothing was hit */
  lks_unit fraction; /* of the way, 0 … 1 */
  lks_unit3 normal;  /* of the body, outward; zero when a ray starts inside */
  lks_position3 point;
  uint32_t part;     /* of the body's asset: triangle, cell or child */
  uint32_t reserved; /* 0 */
} lks_hit;

/* Origins and poses lie within ±2^20 m. Ways reach at most 512 m along each axis. Shapes are
 * spheres, capsules, boxes, or hulls of the world's assets. */

LKS_API lks_status lks_cast_ray(const lks_world* world, const lks_position3* origin,
                                const lks_length3* way, const lks_query_filter* filter,
                                lks_hit* out);

/* Every body along the ray, nearest first, at most `capacity`; `count` were written. */
LKS_API lks_status lks_cast_ray_all(const lks_world* world, const lks_position3* origin,
                                    const lks_length3* way, const lks_query_filter* filter,
                                    lks_hit* out, size_t capacity, size_t* count);

/* 1 when anything is in the way, else 0. */
LKS_API lks_status lks_is_ray_blocked(const lks_world* world, const lks_position3* origin,
                                      const lks_length3* way, const lks_query_filter* filter,
                                      uint32_t* out);

/* The first body that a shape meets on its way. */
LKS_API lks_status lks_cast_shape(const lks_world* world, const lks_shape* shape,
                                  const lks_pose* start, const lks_length3* way,
                                  const lks_query_filter* filter, lks_hit* out);

/* Bodies that overlap, by ascending index, at most `capacity`; `count` were written. */
LKS_API lks_status lks_overlap_sphere(const lks_world* world, const lks_position3* centre,
                                      lks_length radius, const lks_query_filter* filter,
                                      lks_body* out, size_t capacity, size_t* count);
LKS_API lks_status lks_overlap_shape(const lks_world* world, const lks_shape* shape,
                                     const lks_pose* pose, const lks_query_filter* filter,
                                     lks_body* out, size_t capacity, size_t* count);

/* Bodies whose bounds along the world's axes, rounded outward by at most 8 µm, overlap a box, by
 * ascending index. Those of an asset hold its own box, turned as the body is. No coordinate of `lower`
 * may be above that of `upper`. */
LKS_API lks_status lks_bodies_in_box(const lks_world* world, const lks_position3* lower,
                                     const lks_position3* upper, const lks_query_filter* filter,
                                     lks_body* out, size_t capacity, size_t* count);

/* The nearest point of any body within `reach`, 0 … 512 m. */
typedef struct lks_closest {
  lks_body body; /* 0 when nothing is near enough */
  lks_position3 point;
  lks_length distance; /* 0 inside */
  uint32_t part;
} lks_closest;
LKS_API lks_status lks_closest_point(const lks_world* world, const lks_position3* point,
                                     lks_length reach, const lks_query_filter* filter,
                                     lks_closest* out);

#ifdef __cplusplus
}
#endif
#endif
