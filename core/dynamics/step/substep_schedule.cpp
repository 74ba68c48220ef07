#include "core/dynamics/step/substep_schedule.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {
namespace {

// The least number of items in a piece of a loop: about a microsecond of work.
constexpr std::uint32_t k_body_grain = 64;
constexpr std::uint32_t k_joined_grain = 8;
constexpr std::uint32_t k_block_grain = 4;
constexpr std::uint32_t k_one_grain = 1;

// Coloured ball joints converge slowly: iterations before positions move, which decide how far a
// net opens. One follows afterwards.
constexpr int k_ball_passes = 4;

// Loops of a substep: eighteen of bodies, joints, islands and energies; the colours of contacts
// twice, of coloured ball joints once an iteration.
constexpr std::size_t k_most_substep_loops = 18 + (2 + k_ball_passes + 1) * (k_graph_colors + 1);

}  // namespace

SubstepSchedule::SubstepSchedule(int substeps) : substeps_(substeps) {
  const std::size_t most = (static_cast<std::size_t>(substeps) + 1) * k_most_substep_loops;
  loops_.reserve(most);
  stages_.reserve(most);
}

void SubstepSchedule::clear() {
  loops_.clear();
  stages_.clear();
}

void SubstepSchedule::plan_preparation(const TickWork& work) {
  clear();
  add({StageKind::fill_bodies}, work.rows, k_body_grain);
  add_serial(StageKind::begin_joints, work.has_joints);
  const bool has_balls = work.ball_blocks != BlockCounts{};
  add({StageKind::place_joined}, has_balls ? work.joined : 0, k_body_grain);
  add_contacts(StageKind::fill_contacts, work);
  add_balls(StageKind::fill_balls, work);
}

void SubstepSchedule::plan_substeps(const TickWork& work) {
  LKS_ASSERT(work.watched == 0 || work.has_joints);
  clear();
  for (int substep = 0; substep < substeps_; ++substep)
    plan_substep(work, static_cast<std::uint8_t>(substep));
  add({StageKind::whole_islands}, work.whole, k_one_grain);
  add({StageKind::end_islands}, work.converged, k_one_grain);
  add_serial(StageKind::end_joints, work.has_joints);
  if (!work.bounces) return;
  add({StageKind::keep_speeds}, work.bodies, k_body_grain);
  add_contacts(StageKind::bounce, work);
}

// Velocities, contacts that push overlap out, joints such that they hold afterwards; positions;
// joints and contacts such that they stay. Of converged contacts iterations only update the
// separations, as they relax.
void SubstepSchedule::plan_substep(const TickWork& work, std::uint8_t substep) {
  LKS_ASSERT(substep < substeps());
  add({StageKind::note_energies}, work.watched, k_one_grain);
  add({StageKind::velocities, 0, substep}, work.staged_bodies, k_body_grain);
  if (substep != 0) add_gain_limit(StageKind::limit_repeats, work);
  add({StageKind::warm_joints}, work.clusters, k_one_grain);
  add_serial(StageKind::first_impacts, work.has_impacts);
  if (work.iterates) add_contacts(StageKind::solve, work);
  add({StageKind::push_islands}, work.converged, k_one_grain);
  for (int i = 0; i < k_ball_passes; ++i)
    add_balls(StageKind::solve_balls, work);
  add({StageKind::solve_joints}, work.clusters, k_one_grain);
  add({StageKind::limit_moves}, work.watched, k_one_grain);
  add({StageKind::positions}, work.staged_bodies, k_body_grain);
  add({StageKind::move_joined}, work.joined, k_joined_grain);
  add({StageKind::relax_joints}, work.clusters, k_one_grain);
  add_balls(StageKind::update_balls, work);
  add_serial(StageKind::impacts, work.has_impacts);
  if (work.relaxes) add_contacts(StageKind::relax, work, substep);
  add({StageKind::relax_islands}, work.converged, k_one_grain);
  add_gain_limit(StageKind::limit_gains, work);
  add({StageKind::limit_energies}, work.watched, k_one_grain);
  add_serial(StageKind::note_impulses, work.watches_impulses);
}

void SubstepSchedule::plan_store(const TickWork& work) {
  clear();
  add_contacts(StageKind::store, work);
}

void SubstepSchedule::add(Stage stage, std::uint32_t count, std::uint32_t grain) {
  if (count == 0) return;
  LKS_ASSERT(is_reserved(loops_, loops_.size() + 1));
  loops_.push_back({count, grain});
  stages_.push_back(stage);
}

void SubstepSchedule::add_serial(StageKind kind, bool is_due) {
  add({kind}, is_due ? 1 : 0, k_one_grain);
}

// The limit looks at islands one by one, only once a body was pushed hard.
void SubstepSchedule::add_gain_limit(StageKind kind, const TickWork& work) {
  if (!work.iterates || work.contact_blocks == BlockCounts{}) return;
  add({StageKind::note_pushes}, work.staged_bodies, k_body_grain);
  add_serial(kind, true);
}

// The overflow is one piece, which is solved one by one.
void SubstepSchedule::add_colors(Stage stage, const BlockCounts& counts) {
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    if (counts[color] == 0) continue;
    stage.color = static_cast<std::uint8_t>(color);
    add(stage, counts[color], k_block_grain);
    if (color == k_overflow_color) loops_.back().is_serial = true;
  }
}

void SubstepSchedule::add_contacts(StageKind kind, const TickWork& work, std::uint8_t substep) {
  add_colors({kind, 0, substep}, work.contact_blocks);
}

void SubstepSchedule::add_balls(StageKind kind, const TickWork& work) {
  add_colors({kind}, work.ball_blocks);
}

}  // namespace lockstone
