/* Joints: they hold two bodies together, limit their relative motion, or drive it. */
#ifndef LOCKSTONE_C_JOINTS_H
#define LOCKSTONE_C_JOINTS_H

#include "bodies.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names a joint, as lks_body names a body. */
typedef uint64_t lks_joint;

enum {
  LKS_JOINT_DISTANCE = 1,
  LKS_JOINT_BALL = 2,
  LKS_JOINT_HINGE = 3,
  LKS_JOINT_SLIDER = 4,
  LKS_JOINT_WELD = 5,
  LKS_JOINT_WHEEL = 6,
  LKS_JOINT_MOTOR = 7,
  LKS_JOINT_SIX_AXIS = 8,
  LKS_JOINT_PULLEY = 9,
  LKS_JOINT_GEAR = 10,
  LKS_JOINT_RACK = 11,
  LKS_JOINT_RATCHET = 12,
  LKS_JOINT_PATH = 13
};

enum { LKS_AXIS_LOCKED = 0, LKS_AXIS_FREE = 1, LKS_AXIS_LIMITED = 2 };

/* One way to move. Of a linear axis `lower`, `upper` and `target` are lks_length, `speed`
 * lks_speed, `max_effort` newtons; of an angular one lks_angle, lks_rate, newton metres. The drive
 * is on when `hertz` or `max_effort` is above 0: a motor without hertz, a spring with them.
 * docs/reference/joints.md. */
typedef struct lks_axis {
  uint32_t mode;
  int32_t lower;
  int32_t upper;
  int32_t target;
  int32_t speed;
  lks_number hertz;         /* 0 … 1000 */
  lks_number damping_ratio; /* 0 … 100 */
  uint32_t reserved;        /* 0 */
  lks_force max_effort;     /* ≥ 0 */
} lks_axis;

/* Where a joint sits on a body: in the frame of its shape. */
typedef struct lks_joint_frame {
  lks_length3 position;
  lks_quat orientation;
} lks_joint_frame;

/* A joint to be made. Angular axes: [0] twist about x, [1] and [2] swing about y and z. */
typedef struct lks_joint_def {
  uint32_t size;
  uint32_t kind;
  lks_body body_a;
  lks_body body_b;
  lks_joint_frame frame_a;
  lks_joint_frame frame_b;
  lks_axis linear[3];
  lks_axis angular[3];
  lks_position3 ground_a; /* pulley: the fixed points */
  lks_position3 ground_b;
  lks_number ratio;      /* pulley, gear, rack; ratchet: teeth in a turn, whole, 2 … 1000 */
  uint32_t collide;      /* 1: the two bodies may touch */
  lks_force break_force; /* the joint is destroyed beyond it; 0: never */
  lks_force break_torque;
  uint64_t user_data;
  uint64_t path; /* path joint: the name of its path, in frame a */
} lks_joint_def;

/* Locks and frees the axes as the kind says. */
LKS_API lks_status lks_joint_def_init(lks_joint_def* def, size_t size, uint32_t kind, lks_body a,
                                      lks_body b);

/* A joint as it stands after the last step. */
typedef struct lks_joint_view {
  uint32_t size;
  uint32_t kind;
  lks_body body_a;
  lks_body body_b;
  uint64_t user_data;
  lks_length3 offset; /* of frame B against frame A, along the axes of A; of a path joint x is the
                       * distance along the path */
  lks_angle3 angle;   /* twist and swing */
  lks_force3 force;   /* on body b in the last substep, along the joint's axes */
  lks_force3 torque;
} lks_joint_view;

LKS_API lks_status lks_create_joint(lks_world* world, const lks_joint_def* def, lks_joint* out);
LKS_API lks_status lks_destroy_joint(lks_world* world, lks_joint joint);

/* New settings for one axis, limits and drive alike: axis 0 … 2. */
LKS_API lks_status lks_set_linear_axis(lks_world* world, lks_joint joint, uint32_t axis,
                                       const lks_axis* settings);
LKS_API lks_status lks_set_angular_axis(lks_world* world, lks_joint joint, uint32_t axis,
                                        const lks_axis* settings);

/* `out->size` must be set. */
LKS_API lks_status lks_joint_get(const lks_world* world, lks_joint joint, lks_joint_view* out);

/* All joints by ascending index, as lks_bodies. `joints` may be null. */
LKS_API lks_status lks_joints(const lks_world* world, lks_joint* joints, size_t capacity,
                              size_t* count);

#ifdef __cplusplus
}
#endif
#endif
