/* Events of the last step. Read them before the next one: they are not state. */
#ifndef LOCKSTONE_C_EVENTS_H
#define LOCKSTONE_C_EVENTS_H

#include "joints.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  LKS_CONTACT_BEGIN = 0,
  LKS_CONTACT_END = 1,
  LKS_TRIGGER_ENTER = 2,
  LKS_TRIGGER_STAY = 3,
  LKS_TRIGGER_EXIT = 4,
  LKS_IMPACT = 5, /* `a` was stopped on its way by `b` within the tick */
  LKS_SLEEP = 6,  /* `a` fell asleep; `b` is 0 */
  LKS_WAKE = 7,
  LKS_CONTACT_PERSIST = 8 /* they touch, as a tick ago: LKS_BODY_PERSIST_EVENTS */
};

typedef struct lks_event {
  uint32_t kind;
  uint32_t reserved; /* 0 */
  lks_body a;
  lks_body b;
  lks_velocity approach_speed; /* of contact begin and impact, ≥ 0 */
  uint32_t tag_a;              /* of the surfaces where they meet */
  uint32_t tag_b;
} lks_event;

/* Two bodies came together faster than the hit speed of one of them, and pushed each other. */
typedef struct lks_hit_event {
  lks_body a;
  lks_body b;
  lks_position3 point;           /* mean of the contact's points, weighted by their impulses */
  lks_impulse normal_impulse;    /* of the tick, at all points, > 0 */
  lks_impulse3 friction_impulse; /* of the tick, on b */
  lks_velocity approach_speed;   /* > 0 */
  lks_unit3 normal;              /* from a to b */
  uint32_t was_stopped;          /* 1: as of LKS_IMPACT */
  uint32_t part_a;               /* triangle, cell or child where they meet */
  uint32_t part_b;
  uint32_t tag_a; /* of the surfaces where they meet */
  uint32_t tag_b;
} lks_hit_event;

/* A joint broke in the last step. */
typedef struct lks_joint_event {
  lks_joint joint;
  lks_body a;
  lks_body b;
  uint64_t user_data;
} lks_joint_event;

/* Contacts and triggers by pair, then impacts, then sleep and wake. `count` is the number of
 * events; LKS_BUFFER_TOO_SMALL, with the first `capacity` written, when that is more. */
LKS_API lks_status lks_events(const lks_world* world, lks_event* out, size_t capacity,
                              size_t* count);
LKS_API lks_status lks_joint_events(const lks_world* world, lks_joint_event* out, size_t capacity,
                                    size_t* count);

LKS_API lks_status lks_hit_events(const lks_world* world, lks_hit_event* out, size_t capacity,
                                  size_t* count);

/* A point of a contact. Forces are those of the last substep of the last step. */
typedef struct lks_touching_point {
  lks_position3 point;         /* in the middle between both surfaces */
  lks_force normal_force;      /* ≥ 0 */
  lks_displacement separation; /* negative when overlapping */
  uint32_t reserved;           /* 0 */
} lks_touching_point;

/* A contact of a body with another. */
typedef struct lks_body_contact {
  lks_body other;
  lks_touching_point points[4]; /* the first `count` */
  lks_force normal_force;       /* pushes the other along the normal, at all points */
  lks_force3 friction;          /* on the other */
  lks_unit3 normal;             /* from the body to the other */
  uint32_t count;               /* 0 where the two parted within the step */
  uint32_t part;                /* triangle, cell or child of the body's asset */
  uint32_t other_part;
  uint32_t tag; /* of the body's surface where they meet */
  uint32_t other_tag;
} lks_body_contact;

/* The contacts in which a body touches others as of the last step, by the other's index, at most
 * `capacity`; `count` were written. Its joints likewise. */
LKS_API lks_status lks_contacts_of(const lks_world* world, lks_body body, lks_body_contact* out,
                                   size_t capacity, size_t* count);
LKS_API lks_status lks_joints_of(const lks_world* world, lks_body body, lks_joint* out,
                                 size_t capacity, size_t* count);

/* 1 when two bodies touch as of the last step, else 0. */
LKS_API lks_status lks_touching(const lks_world* world, lks_body a, lks_body b, uint32_t* out);

#ifdef __cplusplus
}
#endif
#endif
