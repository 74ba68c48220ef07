// The contacts of an island between the iterations' blocks and the proximal problem: takes them
// over as the tick begins, sets their rows for each phase, and writes impulses back.
#pragma once

#include <cstdint>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/island_pool.h"

namespace lockstone::contact_phases {

/// Once blocks are prepared: takes an island's contacts over from the iterations, and finds its
/// rows. `weight` is gravity's gain in a substep, m/s, Q32.
void begin(const ContactRun& run, const IslandView& island, std::int64_t weight, int substeps);

/// Before the first phase of a substep: the rows' speeds, and the centres less their leaks.
void begin_substep(const IslandView& island);

/// Before the second phase: the leak drives overlap out, and this phase, which leaves overlap
/// alone, has none.
void return_leaks(const IslandView& island);

/// Sets the speeds at which separations close, or overlap is pushed out. Where contacts beside
/// joints become softer or harder, the factor at hand is of no use any more.
void set_biases(const ContactRun& run, const IslandView& island, bool pushes_out);

/// An impact need not be solved as finely as rest: nothing is solved below a part of the fastest
/// approach with which the substep began, nor below a speed that grows with the island's stir.
void loosen(const IslandView& island);

/// After a phase: adds its impulses to the blocks, and their changes of motion to the bodies.
void give(const ContactRun& run, const IslandView& island);

/// The impulses of a contact's friction now, as the word of a block.
[[nodiscard]] std::int64_t friction_word(const ProximalContact& contact);

/// After the last phase: writes friction to the blocks, and gives the contacts back to the
/// iterations.
void end(const ContactRun& run, const IslandView& island);

}  // namespace lockstone::contact_phases
