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
  LKS_WAKE = 7
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

/* 1 when two bodies touch as of the last step, else 0. */
LKS_API lks_status lks_touching(const lks_world* world, lks_body a, lks_body b, uint32_t* out);

#ifdef __cplusplus
}
#endif
#endif
