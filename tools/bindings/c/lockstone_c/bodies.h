/* Bodies: made, read, and moved by commands. */
#ifndef LOCKSTONE_C_BODIES_H
#define LOCKSTONE_C_BODIES_H

#include "world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names a body: index in the low half, generation in the high one. The name of a body that was
 * destroyed never names another one. 0: no body. */
typedef uint64_t lks_body;

enum { LKS_STATIC = 1, LKS_KINEMATIC = 2, LKS_DYNAMIC = 3 };

enum { LKS_FRAME_WORLD = 0, LKS_FRAME_BODY = 1 };

/* How a property of two surfaces becomes one of the pair; the later of two rules decides. */
enum {
  LKS_COMBINE_STANDARD = 0,
  LKS_COMBINE_AVERAGE = 1,
  LKS_COMBINE_GEOMETRIC_MEAN = 2,
  LKS_COMBINE_MINIMUM = 3,
  LKS_COMBINE_MULTIPLY = 4,
  LKS_COMBINE_MAXIMUM = 5
};

/* Bits of lks_body_def::flags. */
enum {
  LKS_BODY_TRIGGER = 1,        /* reports overlaps, pushes nothing */
  LKS_BODY_FIXED_ROTATION = 2, /* never rotates */
  LKS_BODY_BULLET = 4,         /* never passes through dynamic bodies either */
  LKS_BODY_ALLOW_SLEEP = 8,    /* set by default */
  LKS_BODY_ASLEEP = 16,        /* in views only */
  LKS_BODY_DISABLED = 32       /* in views only */
};

/* Bits of events: which events a body has. */
enum {
  LKS_BODY_CONTACT_EVENTS = 1, /* set by default */
  LKS_BODY_PERSIST_EVENTS = 2  /* LKS_CONTACT_PERSIST in every tick of a contact */
};

/* Bits of locks: world axes that a dynamic body does not move along, or turn about. */
enum {
  LKS_LOCK_MOVE_X = 1,
  LKS_LOCK_MOVE_Y = 2,
  LKS_LOCK_MOVE_Z = 4,
  LKS_LOCK_TURN_X = 8,
  LKS_LOCK_TURN_Y = 16,
  LKS_LOCK_TURN_Z = 32
};

typedef struct lks_surface {
  lks_unit friction;           /* 0 … 1.99 */
  lks_unit restitution;        /* 0 … 1 */
  lks_unit rolling_resistance; /* 0 … 1 */
  uint32_t friction_rule;
  uint32_t restitution_rule;
  uint32_t rolling_rule;
  uint32_t tag; /* the game's own; found in events and queries */
} lks_surface;

/* The motion of a surface that stays in place, as of a belt, in the axes of the body's shape. */
typedef struct lks_surface_motion {
  lks_speed3 velocity; /* each component within ±500 m/s */
  lks_rate3 turning;   /* rad/s, each within ±500 */
} lks_surface_motion;

/* With an equal non-zero group the sign decides: positive always meets, negative never. Else both
 * must find the other's category in their mask. */
typedef struct lks_filter {
  uint32_t category;
  uint32_t mask;
  int32_t group;
} lks_filter;

/* A body to be made. Position and orientation place the frame of its shape; velocities are those of
 * the centre of mass. */
typedef struct lks_body_def {
  uint32_t size;
  uint32_t motion;
  lks_shape shape;
  lks_position3 position; /* within ±2^20 m */
  lks_velocity3 velocity; /* at most 500 m/s */
  lks_angular_velocity3 angular_velocity;
  lks_quat orientation;
  lks_surface surface;
  lks_density density;               /* > 0 */
  lks_surface_motion surface_motion; /* of static and kinematic bodies */
  lks_filter filter;
  lks_number gravity_scale;
  lks_rate linear_damping; /* ≥ 0 */
  lks_rate angular_damping;
  uint32_t flags;
  uint32_t locks;
  lks_velocity speed_limit; /* > 0 */
  lks_angular_velocity angular_speed_limit;
  uint64_t user_data; /* the game's own; part of the state */
  uint32_t events;
  lks_speed hit_speed;  /* approaches above it are hits, 0 … 500 m/s; 0: none are */
  lks_mass mass;        /* of a dynamic body; 0: by its density */
  lks_inertia3 inertia; /* principal moments; all 0: those of the solid */
} lks_body_def;

/* Sets the defaults: a dynamic sphere of 0.5 m of 1000 kg/m³. */
LKS_API lks_status lks_body_def_init(lks_body_def* def, size_t size);

/* A body as it stands. */
typedef struct lks_body_view {
  uint32_t size;
  uint32_t motion;
  lks_shape shape;
  lks_position3 position; /* of the shape's frame */
  lks_position3 centre_of_mass;
  lks_velocity3 velocity;
  lks_angular_velocity3 angular_velocity;
  lks_quat orientation;
  lks_surface surface;
  lks_filter filter;
  uint32_t flags;
  uint32_t locks;
  lks_mass mass; /* 0 of static and kinematic bodies */
  uint64_t user_data;
  uint32_t events;
  lks_speed hit_speed;
  lks_inertia3 inertia;    /* principal moments, 0 of static and kinematic bodies */
  lks_quat principal_axes; /* in the world: columns of its matrix */
  lks_surface_motion surface_motion;
  lks_number gravity_scale;
  lks_rate linear_damping;
  lks_rate angular_damping;
  uint32_t reserved;
  lks_velocity speed_limit;
  lks_angular_velocity angular_speed_limit;
} lks_body_view;

/* Commands: the only way to write a world. On any status but LKS_OK nothing has changed. */

LKS_API lks_status lks_create_body(lks_world* world, const lks_body_def* def, lks_body* out);
LKS_API lks_status lks_destroy_body(lks_world* world, lks_body body);

/* Moves a body at once; its contacts end. */
LKS_API lks_status lks_teleport(lks_world* world, lks_body body, const lks_pose* pose);

LKS_API lks_status lks_set_velocity(lks_world* world, lks_body body, const lks_velocity3* velocity);
LKS_API lks_status lks_set_angular_velocity(lks_world* world, lks_body body,
                                            const lks_angular_velocity3* velocity);

/* At the centre of mass, in the axes of `frame`. */
LKS_API lks_status lks_apply_impulse(lks_world* world, lks_body body, const lks_impulse3* impulse,
                                     uint32_t frame);

/* At a point within twice the body's radius of its centre of mass. In the world's frame the point
 * is relative to the centre of mass. */
LKS_API lks_status lks_apply_impulse_at(lks_world* world, lks_body body,
                                        const lks_impulse3* impulse, const lks_length3* point,
                                        uint32_t frame);
LKS_API lks_status lks_apply_angular_impulse(lks_world* world, lks_body body,
                                             const lks_impulse3* impulse, uint32_t frame);

/* Forces and torques work over the coming tick and are then gone. */
LKS_API lks_status lks_apply_force(lks_world* world, lks_body body, const lks_force3* force,
                                   uint32_t frame);
LKS_API lks_status lks_apply_force_at(lks_world* world, lks_body body, const lks_force3* force,
                                      const lks_length3* point, uint32_t frame);
LKS_API lks_status lks_apply_torque(lks_world* world, lks_body body, const lks_force3* torque,
                                    uint32_t frame);

/* Gives a kinematic body the velocities that take it to a pose in one tick. */
LKS_API lks_status lks_move_kinematic(lks_world* world, lks_body body, const lks_pose* pose);

LKS_API lks_status lks_set_material(lks_world* world, lks_body body, const lks_surface* surface);
LKS_API lks_status lks_set_surface_motion(lks_world* world, lks_body body,
                                          const lks_surface_motion* motion);
LKS_API lks_status lks_set_gravity_scale(lks_world* world, lks_body body, lks_number scale);
LKS_API lks_status lks_set_damping(lks_world* world, lks_body body, lks_rate linear,
                                   lks_rate angular);
LKS_API lks_status lks_set_axis_locks(lks_world* world, lks_body body, uint32_t locks);
LKS_API lks_status lks_set_speed_limit(lks_world* world, lks_body body, lks_velocity linear,
                                       lks_angular_velocity angular);
LKS_API lks_status lks_set_filter(lks_world* world, lks_body body, const lks_filter* filter);
/* Changes no motion. */
LKS_API lks_status lks_set_events(lks_world* world, lks_body body, uint32_t events,
                                  lks_speed hit_speed);
LKS_API lks_status lks_set_user_data(lks_world* world, lks_body body, uint64_t user_data);

/* Its place, velocities and joints stay; its contacts end. `mass`: of a body that becomes dynamic;
 * 0: of its solid at 1000 kg/m³. */
LKS_API lks_status lks_set_motion_type(lks_world* world, lks_body body, uint32_t motion,
                                       lks_mass mass);
/* In the frame of the old shape. `mass`: of a dynamic body; 0: it keeps its own. */
LKS_API lks_status lks_set_shape(lks_world* world, lks_body body, const lks_shape* shape,
                                 lks_mass mass);
/* Of a dynamic body; mass 0: it keeps its own. `inertia`: principal moments; null or all 0: those
 * of the solid with this mass. */
LKS_API lks_status lks_set_mass_data(lks_world* world, lks_body body, lks_mass mass,
                                     const lks_inertia3* inertia);
/* A disabled body stays as it is until it is enabled: nothing meets or finds it, and its joints do
 * nothing. */
LKS_API lks_status lks_set_enabled(lks_world* world, lks_body body, uint32_t enabled);

/* Wakes a body and its island; commands that push or move a body do so by themselves. */
LKS_API lks_status lks_wake_body(lks_world* world, lks_body body);
LKS_API lks_status lks_sleep_body(lks_world* world, lks_body body);
LKS_API lks_status lks_set_allow_sleep(lks_world* world, lks_body body, uint32_t allow);
LKS_API lks_status lks_set_gravity(lks_world* world, const lks_acceleration3* gravity);

/* A box of fluid below a flat surface: water, mud, wind. It carries, brakes and drives the dynamic
 * bodies in it. */
typedef struct lks_fluid {
  uint32_t size;
  uint32_t mask;         /* categories of the bodies that it acts on */
  lks_position3 surface; /* the centre of the surface */
  lks_position3 extents; /* half the width, the depth, half the length: 0 … 2^21 m */
  lks_velocity3 flow;    /* each component within ±500 m/s */
  lks_quat orientation;  /* y points out of the surface */
  lks_density density;   /* 0: there is no such fluid */
  lks_number drag;       /* coefficient of the form, 0 … 100 */
  lks_rate linear_drag;  /* 1/s, ≥ 0 */
  uint32_t reserved;
} lks_fluid;

/* Sets the defaults: no density, every category. */
LKS_API lks_status lks_fluid_init(lks_fluid* fluid, size_t size);
/* Sets or changes fluid 0 … 15, or with density 0 removes it. */
LKS_API lks_status lks_set_fluid(lks_world* world, uint32_t number, const lks_fluid* fluid);
/* `out->size` must be set. */
LKS_API lks_status lks_fluid_get(const lks_world* world, uint32_t number, lks_fluid* out);

/* The surface of a contact, in place of the one that combines both sides. */
typedef struct lks_pair_surface {
  lks_unit friction;           /* 0 … 1.99 */
  lks_unit restitution;        /* 0 … 1 */
  lks_unit rolling_resistance; /* 0 … 1 */
} lks_pair_surface;

/* How two bodies treat each other, until one of them is destroyed: whether they meet (1 or 0), and
 * the surface of their contacts, or null. 1 and null take the rule back. At most 255 rules. */
LKS_API lks_status lks_set_pair_rule(lks_world* world, lks_body a, lks_body b, uint32_t collides,
                                     const lks_pair_surface* surface);
LKS_API lks_status lks_pair_rule_get(const lks_world* world, lks_body a, lks_body b,
                                     uint32_t* collides, uint32_t* has_surface,
                                     lks_pair_surface* surface);
/* The surface of all contacts between two tags; null takes the rule back. At most 128 rules. */
LKS_API lks_status lks_set_surface_rule(lks_world* world, uint32_t tag_a, uint32_t tag_b,
                                        const lks_pair_surface* surface);
LKS_API lks_status lks_surface_rule_get(const lks_world* world, uint32_t tag_a, uint32_t tag_b,
                                        uint32_t* has_surface, lks_pair_surface* surface);
/* A static or kinematic body that stops others from one side only: the direction points out of its
 * front, in the axes of its shape; contacts hold within 1 … 90 degrees of it. Zero: from every
 * side. */
LKS_API lks_status lks_set_one_way(lks_world* world, lks_body body, const lks_unit3* direction,
                                   uint32_t tolerance);
LKS_API lks_status lks_one_way_get(const lks_world* world, lks_body body, lks_unit3* direction,
                                   uint32_t* tolerance);

/* Names a body for people: not state. 28 bytes of UTF-8 and no more are kept. */
LKS_API lks_status lks_set_name(lks_world* world, lks_body body, const char* name);

/* Reading. */

/* 1 or 0. */
LKS_API lks_status lks_body_exists(const lks_world* world, lks_body body, uint32_t* out);

/* `out->size` must be set. */
LKS_API lks_status lks_body_get(const lks_world* world, lks_body body, lks_body_view* out);
LKS_API lks_status lks_body_pose(const lks_world* world, lks_body body, lks_pose* out);
LKS_API lks_status lks_body_velocity(const lks_world* world, lks_body body, lks_velocity3* out);

/* All bodies by ascending index. Each array has `capacity` elements or is null. `count` is the
 * number of bodies; LKS_BUFFER_TOO_SMALL, with the first `capacity` written, when that is more. */
LKS_API lks_status lks_bodies(const lks_world* world, lks_body* bodies, lks_pose* poses,
                              lks_velocity3* velocities, size_t capacity, size_t* count);

#ifdef __cplusplus
}
#endif
#endif
