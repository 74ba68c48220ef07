// The speeds of a contact's rows as the tick begins, and those that moving surfaces give them.
#pragma once

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/island_pool.h"
#include "core/dynamics/problem/proximal_rows.h"

namespace lockstone {

/// Sets `moved` and `moving`: speeds as the tick begins, and once gravity and forces have acted.
void measure_speeds(const ContactRun& run, const PreparedRows& prepared,
                    const ProximalContact& contact, lanes::ProximalBlock& problem);

/// As the tick begins, of an island whose state says `is_measured`: the part of each row's speed
/// that kinematic bodies give it.
void begin_measuring(const ContactRun& run, const IslandView& island);

/// Before a phase of such an island: sets `moving` as its bodies move now.
void measure_again(const ContactRun& run, const IslandView& island);

/// Moving surfaces add to the speeds of friction: the drive is a mean of the tick's substeps.
void set_drives(const ContactRun& run, int substeps, ProximalContact& contact,
                lanes::ProximalBlock& problem);

}  // namespace lockstone
