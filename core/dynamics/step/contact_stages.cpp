// The loops of a tick's substeps, and in which order they go.

#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {
namespace {

using lanes::ManifoldKernels;

// The least number of items in a piece of a loop: about a microsecond of work.
constexpr std::uint32_t k_body_grain = 64;
constexpr std::uint32_t k_joined_grain = 8;
constexpr std::uint32_t k_block_grain = 4;
constexpr std::uint32_t k_cluster_grain = 1;

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 1 & 0x55555555U) | (x & 0x55555555U) << 1;
  x = (x >> 2 & 0x33333333U) | (x & 0x33333333U) << 2;
  x = (x >> 4 & 0x0f0f0f0fU) | (x & 0x0f0f0f0fU) << 4;
  x = (x >> 8 & 0x00ff00ffU) | (x & 0x00ff00ffU) << 8;
  return x >> 16 | x << 16;
}
static_assert(reversed(0x80000000U) == 1 && reversed(0x12345678U) == 0x1e6a2c48U);

// Limits of friction are few steps of their format high: rounded alike in all substeps they would
// err the same way for as long as something slides. Two sequences that fill the unit interval
// evenly (van der Corput's, and multiples of the golden ratio) round them in turns instead.
lanes::SweepRules swayed(lanes::SweepRules rules, std::uint32_t substep) {
  constexpr std::uint32_t k_golden = 0x9e3779b9;
  constexpr std::int32_t k_half = 1 << 29;
  rules.limit_sway = static_cast<std::int32_t>(reversed(substep) >> 2) - k_half;
  rules.part_sway = static_cast<std::int32_t>((substep * k_golden) >> 2) - k_half;
  return rules;
}

// Nets converge slowly: iterations before positions move, and after.
constexpr int k_net_sweeps = 2;

}  // namespace

void ContactSolver::prepare(const ContactScene& scene, Parallel& parallel) {
  const bool was_idle = is_idle_;
  is_idle_ = scene.records.empty() && scene.joint_links.empty();
  if (is_idle_ && was_idle) return;
  take_up_contacts(scene, parallel);
  lay_out(parallel);
  points_ = saturations_ = 0;
  first_substep_ =
      static_cast<std::uint32_t>(scene.tick) * static_cast<std::uint32_t>(step_.substeps);
  bounces_ = holds_ = false;
  loops_.clear();
  stages_.clear();
  const std::uint32_t joints = joints_->empty() ? 0 : 1;
  add_loop({StageKind::velocities}, row_count(), k_body_grain);
  add_loop({StageKind::warm_joints}, joints, 1, true);
  add_loop({StageKind::move_joined}, net_.empty() ? 0 : joints_->body_count(), k_body_grain);
  add_loop_of_each_color(StageKind::solve);
  add_net_loops(StageKind::lift_net);
  parallel.run_all(loops_, [&](std::size_t loop, std::uint32_t first, std::uint32_t end,
                               std::uint32_t) { prepare_piece(scene, stages_[loop], first, end); });
  parallel.for_each({joints_->cluster_count(), k_cluster_grain},
                    [&](std::size_t first, std::size_t end, std::uint32_t) {
                      joints_->prepare(joint_run(), first, end);
                    });
  find_impacts(scene);
  if (bounces_ || joints_->has_own()) find_fed_islands(scene);
  energy_limit_.begin(energy_bodies());
  begin_converged(scene);
  find_first_loads(scene, parallel);
}

void ContactSolver::prepare_piece(const ContactScene& scene, const Stage& stage, std::size_t first,
                                  std::size_t end) {
  switch (stage.kind) {
    case StageKind::velocities:
      return fill_bodies(scene, first, end);
    case StageKind::warm_joints:
      return begin_joints();
    case StageKind::move_joined:
      return joints_->place(joint_run(), first, end);
    case StageKind::lift_net:
      return net_.fill(net_run(), stage.color, first, end);
    default:
      return fill_blocks(scene, stage.color, first, end);
  }
}

void ContactSolver::add_loop(Stage stage, std::uint32_t count, std::uint32_t grain,
                             bool is_serial) {
  if (count == 0) return;
  loops_.push_back({count, grain, is_serial});
  stages_.push_back(stage);
}

// The overflow is one piece, which is solved one by one.
void ContactSolver::add_loop_of_each_color(StageKind kind, std::uint8_t substep) {
  const auto blocks = [&](std::size_t color) {
    return static_cast<std::uint32_t>(ranges_[color].count);
  };
  for (std::size_t color = 0; color < k_graph_colors && blocks(color) != 0; ++color)
    add_loop({kind, static_cast<std::uint8_t>(color), substep}, blocks(color), k_block_grain);
  add_loop({kind, k_overflow_color, substep}, blocks(k_overflow_color), k_block_grain, true);
}

void ContactSolver::add_net_loops(StageKind kind) {
  if (net_.empty()) return;
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    add_loop({kind, static_cast<std::uint8_t>(color)}, net_.block_count(color), k_block_grain,
             color == k_overflow_color);
  }
}

EnergyLimit::Bodies ContactSolver::energy_bodies() {
  return {members_, bodies_, rows_, before_, islands_, *joints_};
}

std::uint32_t ContactSolver::energy_limits() const {
  return energy_limit_.count() + joints_->energy_limits();
}

// Velocities, contacts that push overlap out, joints such that they hold afterwards; positions;
// joints and contacts such that they stay.
void ContactSolver::add_loops_of_substep(std::uint8_t substep) {
  const std::uint32_t clusters = joints_->cluster_count();
  const auto bodies = static_cast<std::uint32_t>(members_.size());
  const std::uint32_t watches = energy_limit_.watches() ? 1 : 0;
  add_loop({StageKind::note_energies}, watches, 1, true);
  add_loop({StageKind::velocities, 0, substep}, bodies, k_body_grain);
  add_loop({StageKind::warm_joints}, clusters, k_cluster_grain);
  const std::uint32_t impacts = impacts_.empty() ? 0 : 1;
  add_loop({StageKind::impacts}, impacts, 1, true);
  add_loop_of_each_color(StageKind::solve);
  add_loop({StageKind::push_islands}, converged_islands(), 1);
  for (int i = 0; i < k_net_sweeps; ++i)
    add_net_loops(StageKind::lift_net);
  add_loop({StageKind::solve_joints}, clusters, k_cluster_grain);
  add_loop({StageKind::limit_moves}, watches, 1, true);
  add_loop({StageKind::positions}, bodies, k_body_grain);
  add_loop({StageKind::move_joined}, joints_->body_count(), k_joined_grain);
  add_loop({StageKind::relax_joints}, clusters, k_cluster_grain);
  add_net_loops(StageKind::follow_net);
  for (int i = 1; i < k_net_sweeps; ++i)
    add_net_loops(StageKind::relax_net);
  add_loop({StageKind::impacts}, impacts, 1, true);
  add_loop_of_each_color(StageKind::relax, substep);
  add_loop({StageKind::relax_islands}, converged_islands(), 1);
  add_loop({StageKind::limit_energies}, watches, 1, true);
}

// All substeps; then colours that bounce.
void ContactSolver::run(Parallel& parallel) {
  if (entries_.empty() && joints_->empty()) return;
  loops_.clear();
  stages_.clear();
  for (int substep = 0; substep < step_.substeps; ++substep)
    add_loops_of_substep(static_cast<std::uint8_t>(substep));
  add_loop({StageKind::end_islands}, converged_islands(), 1);
  if (bounces_) {
    add_loop({StageKind::keep_speeds}, static_cast<std::uint32_t>(members_.size()), k_body_grain);
    add_loop_of_each_color(StageKind::bounce);
  }
  parallel.run_all(loops_, [&](std::size_t loop, std::uint32_t first, std::uint32_t end,
                               std::uint32_t) { run_piece(stages_[loop], first, end); });
  joints_->end(joint_run());
}

void ContactSolver::run_piece(const Stage& stage, std::size_t first, std::size_t end) {
  switch (stage.kind) {
    case StageKind::velocities:
      return integrate_velocities(stage.substep == 0, first, end);
    case StageKind::note_energies:
      return energy_limit_.note(energy_bodies());
    case StageKind::limit_moves:
      return energy_limit_.limit_moves(energy_bodies());
    case StageKind::limit_energies:
      return energy_limit_.limit_gains(energy_bodies());
    case StageKind::warm_joints:
      return joints_->warm_start(joint_run(), first, end);
    case StageKind::impacts:
      return run_impacts();
    case StageKind::lift_net:
      return net_.lift(net_run(), stage.color, first, end);
    case StageKind::push_islands:
    case StageKind::relax_islands:
    case StageKind::end_islands:
      return run_converged(stage.kind, first, end);
    case StageKind::solve_joints:
      return joints_->solve(joint_run(), first, end);
    case StageKind::positions:
      return integrate_positions(first, end);
    case StageKind::keep_speeds:
      return keep_speeds(first, end);
    case StageKind::move_joined:
      return joints_->move(joint_run(), first, end);
    case StageKind::relax_joints:
      return joints_->relax(joint_run(), first, end);
    case StageKind::follow_net:
      return net_.follow(net_run(), stage.color, first, end);
    case StageKind::relax_net:
      return net_.relax(net_run(), stage.color, first, end);
    default:
      return sweep(stage, first, end);
  }
}

void ContactSolver::sweep(const Stage& stage, std::size_t first, std::size_t end) {
  const ManifoldKernels& kernels = kernels_of(stage.color);
  const std::size_t begin = ranges_[stage.color].first + first;
  if (stage.kind == StageKind::bounce) {
    bounce(kernels, begin, begin + end - first);
  } else if (stage.kind == StageKind::relax) {
    kernels.relax(rows_.data(), travel_.data(), &blocks_[begin], end - first,
                  swayed(rules_, first_substep_ + stage.substep));
  } else {
    kernels.solve(rows_.data(), &blocks_[begin], end - first, rules_);
  }
  hold_blocks(begin, begin + end - first);
}

}  // namespace lockstone
