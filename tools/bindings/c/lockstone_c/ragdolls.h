/* Ragdolls, and points that are dragged: bodies and joints, made and changed by commands.
 * docs/how-to/ragdolls.md. */
#ifndef LOCKSTONE_C_RAGDOLLS_H
#define LOCKSTONE_C_RAGDOLLS_H

#include "joints.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LKS_MAX_BONES 64
/* The parent of the root. */
#define LKS_NO_BONE 4294967295u

/* A bone of a skeleton. Both poses are those of the bind pose, in the axes of the skeleton. There
 * every joint stands at 0. Positions within 500 m. */
typedef struct lks_bone {
  uint32_t parent;      /* a bone before this one; LKS_NO_BONE of the first alone */
  uint32_t joint;       /* to the parent: LKS_JOINT_BALL, LKS_JOINT_HINGE or LKS_JOINT_WELD */
  lks_shape shape;      /* a capsule of 0.1 m and 0.05 m by default */
  lks_pose pose;        /* of the shape's frame */
  lks_pose joint_frame; /* x: the axis of the twist, of a hinge its axis */
  lks_mass mass;        /* 0: by its density */
  lks_force friction;   /* N·m, ≥ 0: about each axis of a limp joint */
  lks_surface surface;
  lks_density density;
  lks_angle min_twist; /* −π … 0 */
  lks_angle max_twist; /* 0 … π; no limit where the two span a whole turn */
  lks_angle max_swing; /* of a ball, half the angle of its cone, 0 … π; π: none */
  uint32_t reserved;   /* 0 */
} lks_bone;

typedef struct lks_ragdoll_def {
  uint32_t size;
  lks_filter filter;  /* of all bodies; bones that a joint ties never touch */
  uint64_t user_data; /* of all bodies and joints */
} lks_ragdoll_def;

/* The place of a ragdoll, and how far each joint has turned from the bind pose. */
typedef struct lks_ragdoll_pose {
  lks_pose root;                 /* of the root's shape, in the world */
  lks_quat turns[LKS_MAX_BONES]; /* of a joint's frame on the bone against that on the parent; of a
                                  * hinge about x; the root's is not read */
} lks_ragdoll_pose;

/* The bodies and joints of a ragdoll, by bone: the game's own state. */
typedef struct lks_ragdoll {
  uint32_t size;
  uint32_t bone_count;
  lks_body bodies[LKS_MAX_BONES];
  lks_joint joints[LKS_MAX_BONES]; /* to the parent; 0: there is none */
  lks_mass masses[LKS_MAX_BONES];  /* of a bone when it is dynamic */
} lks_ragdoll;

/* How a bone follows a pose. */
enum {
  LKS_BONE_LIMP = 0,     /* not at all */
  LKS_BONE_SPRUNG = 1,   /* by a spring at its joint */
  LKS_BONE_DRIVEN = 2,   /* exactly, as strong as need be */
  LKS_BONE_KINEMATIC = 3 /* as a kinematic body */
};

typedef struct lks_bone_drive {
  uint32_t mode;
  lks_number hertz;         /* of a sprung bone, 0.01 … 1000 */
  lks_number damping_ratio; /* of a sprung bone, 0 … 100 */
  uint32_t reserved;        /* 0 */
  lks_force max_torque;     /* of a sprung bone, N·m about each axis, ≥ 0; 0: no bound */
} lks_bone_drive;

/* Set the defaults: a bone without a parent; every category; no turns; driven. */
LKS_API lks_status lks_bone_init(lks_bone* bone);
LKS_API lks_status lks_ragdoll_def_init(lks_ragdoll_def* def, size_t size);
LKS_API lks_status lks_ragdoll_pose_init(lks_ragdoll_pose* pose);
LKS_API lks_status lks_bone_drive_init(lks_bone_drive* drive);

/* Makes the bodies, all dynamic and limp, then the joints. 1 … LKS_MAX_BONES bones, the root first.
 * `out->size` must be set. On failure no body is left. */
LKS_API lks_status lks_create_ragdoll(lks_world* world, const lks_ragdoll_def* def,
                                      const lks_bone* bones, size_t bone_count,
                                      const lks_ragdoll_pose* pose, lks_ragdoll* out);
/* Destroys the bodies that still exist, and so the joints. */
LKS_API lks_status lks_destroy_ragdoll(lks_world* world, const lks_ragdoll* ragdoll);

/* Drives all joints through the coming tick: from one pose at its beginning to another at its end.
 * `drives`: one for each bone, or a single one for all. May change `ragdoll->joints`. On
 * LKS_STALE_HANDLE and LKS_INVALID_ARGUMENT nothing has changed. */
LKS_API lks_status lks_drive_ragdoll(lks_world* world, const lks_ragdoll_def* def,
                                     const lks_bone* bones, size_t bone_count, lks_ragdoll* ragdoll,
                                     const lks_ragdoll_pose* from, const lks_ragdoll_pose* to,
                                     const lks_bone_drive* drives, size_t drive_count);

/* The pose in which a ragdoll stands. All of its bodies must exist. */
LKS_API lks_status lks_ragdoll_pose_get(const lks_world* world, const lks_bone* bones,
                                        size_t bone_count, const lks_ragdoll* ragdoll,
                                        lks_ragdoll_pose* out);

/* The poses of the bones' shapes in the world: `out` has `bone_count` of them. */
LKS_API lks_status lks_bone_poses(const lks_bone* bones, size_t bone_count,
                                  const lks_ragdoll_pose* pose, lks_pose* out);

/* A spring that pulls a point of a body to a target, as a mouse does. */
typedef struct lks_drag {
  uint32_t size;
  lks_length3 point;        /* that is pulled, in the frame of its shape */
  lks_body ground;          /* a static body, within 2000 m of the targets */
  lks_body body;            /* a dynamic one */
  lks_number hertz;         /* of the spring, above 0, to 1000 */
  lks_number damping_ratio; /* 0 … 100 */
  lks_force max_force;      /* N along each axis of the ground's shape, ≥ 0; 0: no bound */
} lks_drag;

/* Sets the defaults: 5 Hz, damping ratio 1, no bound. */
LKS_API lks_status lks_drag_init(lks_drag* drag, size_t size, lks_body ground, lks_body body);
/* Makes the joint. */
LKS_API lks_status lks_create_drag(lks_world* world, const lks_drag* drag,
                                   const lks_position3* target, lks_joint* out);
/* Gives the joint a new target, and the drag's numbers. */
LKS_API lks_status lks_move_drag(lks_world* world, lks_joint joint, const lks_drag* drag,
                                 const lks_position3* target);

#ifdef __cplusplus
}
#endif
#endif
