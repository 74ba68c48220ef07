/* Lockstone for C11, and for every language that can call C: docs/how-to/bindings.md.
 *
 * Quantities are raw fixed-point integers (lockstone_c/units.h). A function returns LKS_OK or the
 * reason why it did nothing; lks_last_error() then says it in words. Results go to `out` arguments,
 * which are untouched on failure unless said otherwise. A null pointer where none is allowed gives
 * LKS_NULL_ARGUMENT.
 *
 * A structure that begins with `size` may grow: new fields are only appended. Its `…_init` function
 * sets `size` and every default; call it first. A structure without `size` never changes. No
 * structure has padding.
 *
 * One world is used by one thread at a time. Different worlds are independent. */
#ifndef LOCKSTONE_H
#define LOCKSTONE_H

#include "lockstone_c/assets.h"
#include "lockstone_c/base.h"
#include "lockstone_c/bodies.h"
#include "lockstone_c/clients.h"
#include "lockstone_c/events.h"
#include "lockstone_c/games.h"
#include "lockstone_c/hooks.h"
#include "lockstone_c/joints.h"
#include "lockstone_c/logs.h"
#include "lockstone_c/queries.h"
#include "lockstone_c/ragdolls.h"
#include "lockstone_c/recorders.h"
#include "lockstone_c/servers.h"
#include "lockstone_c/sessions.h"
#include "lockstone_c/state.h"
#include "lockstone_c/terrain.h"
#include "lockstone_c/transports.h"
#include "lockstone_c/units.h"
#include "lockstone_c/vehicles.h"
#include "lockstone_c/world.h"

#endif
