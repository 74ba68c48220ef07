#include "core/dynamics/step/contact_solver.h"

#include <algorithm>
#include <atomic>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/contact/recycling_pose.h"
#include "core/dynamics/state/limits.h"

namespace lockstone {
namespace {

// Calls `work(number)` for bodies `first` … `end` − 1 that are not of whole islands.
template <class Work>
void for_staged(std::span<const SolverBody> bodies, std::size_t first, std::size_t end,
                const Work& work) {
  LKS_ASSERT(end <= bodies.size());
  for (auto i = static_cast<std::uint32_t>(std::max<std::size_t>(first, 1)); i < end; ++i)
    if (!bodies[i].is_whole) work(i);
}

// A stage of the limit of energy, for islands that are not solved whole.
void limit_energies(StageKind kind, EnergyLimit& limit, const EnergyLimit::Bodies& all,
                    std::size_t first, std::size_t end) {
  LKS_ASSERT(end <= limit.watched());
  for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
    if (all.islands.tally(limit.island(i)).whole != 0) continue;
    if (kind == StageKind::note_energies)
      limit.note(all, i);
    else if (kind == StageKind::limit_moves)
      limit.limit_moves(all, i);
    else
      limit.limit_gains(all, i);
  }
}

}  // namespace

ContactSolver::ContactSolver(const TimeStep& step, std::size_t body_capacity,
                             std::size_t contact_capacity, std::size_t joint_capacity,
                             std::size_t converged_contacts)
    : bodies_(step, body_capacity, contact_capacity, joint_capacity),
      contacts_(contact_capacity),
      joints_(step, body_capacity, contact_capacity, joint_capacity, converged_contacts != 0,
              bodies_),
      islands_(body_capacity, contact_capacity),
      effort_(step, std::min(converged_contacts, contact_capacity)),
      constraints_(step, body_capacity, contact_capacity, {bodies_, contacts_, islands_, effort_}),
      warm_start_(body_capacity, contact_capacity, joint_capacity,
                  {bodies_, contacts_, islands_, joints_, constraints_.layout(), step.substeps}),
      totals_(most_hits(body_capacity)),
      impacts_(step, contact_capacity, {bodies_, contacts_, islands_, constraints_, totals_}),
      motion_(step, body_capacity + contact_capacity + 1, bodies_),
      bounce_limit_(step, body_capacity, body_capacity + contact_capacity + 1, bodies_, islands_),
      schedule_(step.substeps) {
  if (joint_capacity != 0) energy_limit_.reserve(body_capacity);
  if (effort_.most_island_contacts() == 0) return;
  converged_ = std::make_unique<Converged>(
      step, body_capacity, contact_capacity, joint_capacity,
      std::min(converged_contacts, contact_capacity), effort_.most_island_contacts(),
      WholeIslands::Parts{bodies_, contacts_, islands_, joints_, constraints_, energy_limit_,
                          totals_});
}

ContactSolver::Converged::Converged(const TimeStep& step, std::size_t body_capacity,
                                    std::size_t contact_capacity, std::size_t joint_capacity,
                                    std::size_t converged_contacts,
                                    std::uint32_t most_island_contacts,
                                    const WholeIslands::Parts& parts)
    : islands(step, body_capacity, contact_capacity, joint_capacity, converged_contacts,
              most_island_contacts),
      whole(body_capacity, converged_contacts, joint_capacity, step.substeps, parts, islands) {}

ContactSolver::~ContactSolver() = default;

void ContactSolver::prepare(const ContactScene& scene, Parallel& parallel) {
  LKS_ASSERT(scene.records.size() <= scene.manifold_ids.size());
  LKS_ASSERT(std::ranges::is_sorted(scene.records, {}, &ContactRecord::key));
  LKS_ASSERT(std::ranges::is_sorted(scene.joint_links, {}, &JointLink::joint));
  const bool was_idle = tick_.is_idle;
  tick_.is_idle = scene.records.empty() && scene.joint_links.empty();
  if (tick_.is_idle && was_idle) return;
  tick_.saturations = 0;
  tick_.first_substep =
      static_cast<std::uint32_t>(scene.tick) * static_cast<std::uint32_t>(schedule_.substeps());
  gather(scene, parallel);
  constraints_.lay_out(scene, parallel);
  schedule_.plan_preparation(work());
  schedule_.run(parallel, [&](const Stage& stage, std::size_t first, std::size_t end) {
    prepare_piece(scene, stage, first, end);
  });
  parallel.for_each({joints_.solver().cluster_count(), 1},
                    [&](std::size_t first, std::size_t end, std::uint32_t) {
                      joints_.solver().prepare(joints_.run(), first, end);
                    });
  impacts_.find(scene);
  if (constraints_.has_restitution() || !joints_.solver().empty())
    islands_.find_energy_sources(scene, bodies_, contacts_);
  energy_limit_.begin(energy_bodies());
  warm_start_.find(scene, constraints_.run(), parallel);
  if (converged_ != nullptr) {
    const ConvergedIslands::Tick tick{scene, bodies_, contacts_, islands_, constraints_.layout()};
    parallel.for_each({converged_->islands.count(), 1},
                      [&](std::size_t first, std::size_t end, std::uint32_t) {
                        converged_->islands.begin(tick, constraints_.run(), first, end);
                      });
    converged_->whole.plan();
  }
  totals_.begin(
      scene.watched, contacts_, constraints_,
      converged_ == nullptr ? std::span<const ProximalContact>() : converged_->islands.contacts());
}

// The bodies, contacts, joints and islands of the tick.
void ContactSolver::gather(const ContactScene& scene, Parallel& parallel) {
  effort_.begin(scene.gravity);
  bodies_.clear();
  contacts_.gather(scene, effort_.bearing_impulse(), bodies_, parallel);
  joints_.gather(scene);
  islands_.build(scene, bodies_, contacts_);
  if (converged_ != nullptr)
    converged_->islands.plan(scene, bodies_, contacts_, effort_, islands_, joints_);
  islands_.find_stacks();
  bodies_.reserve_rows();
  joints_.reserve_rows();
  motion_.reserve();
  bounce_limit_.reserve();
  LKS_ASSERT(islands_.count() > 0 && bodies_.row_count() >= bodies_.count());
}

TickWork ContactSolver::work() const {
  TickWork work;
  work.rows = bodies_.row_count();
  work.bodies = work.staged_bodies = bodies_.count();
  work.clusters = joints_.solver().cluster_count();
  work.joined = joints_.solver().body_count();
  work.converged = converged_ == nullptr ? 0 : converged_->islands.count();
  work.iterates =
      converged_ == nullptr || converged_->islands.contacts().size() != contacts_.size();
  work.has_joints = !joints_.empty();
  work.has_impacts = !impacts_.empty();
  work.watched = energy_limit_.watched();
  work.watches_impulses = !totals_.empty();
  work.bounces = constraints_.has_restitution();
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    work.contact_blocks[color] =
        static_cast<std::uint32_t>(constraints_.layout().blocks_of(color).count);
    if (!joints_.balls().empty()) work.ball_blocks[color] = joints_.balls().block_count(color);
  }
  LKS_ASSERT(work.bodies <= work.rows);
  return work;
}

void ContactSolver::prepare_piece(const ContactScene& scene, const Stage& stage, std::size_t first,
                                  std::size_t end) {
  switch (stage.kind) {
    case StageKind::fill_bodies:
      return fill_bodies(scene, first, end);
    case StageKind::begin_joints:
      return joints_.begin();
    case StageKind::place_joined:
      return joints_.solver().place(joints_.run(), first, end);
    case StageKind::fill_balls:
      return joints_.balls().fill(joints_.balls_run(),
                                  {scene.joint_links, scene.bodies, scene.rotations}, stage.color,
                                  first, end);
    default:
      LKS_ASSERT(stage.kind == StageKind::fill_contacts);
      return constraints_.prepare(scene, stage.color, first, end);
  }
}

void ContactSolver::fill_bodies(const ContactScene& scene, std::size_t first, std::size_t end) {
  bodies_.fill(scene, first, end);
  const std::size_t end_of_numbers = std::min<std::size_t>(end, bodies_.count());
  motion_.clear(first, end_of_numbers);
  if (!islands_.has_stacks()) return;
  for (std::size_t i = std::max<std::size_t>(first, 1); i < end_of_numbers; ++i) {
    SolverBody& body = bodies_.constants()[i];
    const std::uint32_t island = islands_.all().of(static_cast<std::uint32_t>(i));
    LKS_ASSERT(island < islands_.count());
    body.rests = islands_.tally(island).is_stack() && EffortPolicy::rests(bodies_.rows()[i], body);
  }
}

void ContactSolver::run(Parallel& parallel) {
  if (contacts_.size() == 0 && joints_.empty()) return;
  TickWork staged = work();
  if (converged_ != nullptr) converged_->whole.leave_out(staged);
  LKS_ASSERT(staged.staged_bodies <= staged.bodies);
  schedule_.plan_substeps(staged);
  schedule_.run(parallel, [&](const Stage& stage, std::size_t first, std::size_t end) {
    run_piece(stage, first, end);
  });
  totals_.end(constraints_.run());
  if (converged_ != nullptr) converged_->islands.give_up(effort_, constraints_.run(), islands_);
}

void ContactSolver::run_piece(const Stage& stage, std::size_t first, std::size_t end) {
  JointSolver& joints = joints_.solver();
  switch (stage.kind) {
    case StageKind::note_energies:
    case StageKind::limit_moves:
    case StageKind::limit_energies:
      return limit_energies(stage.kind, energy_limit_, energy_bodies(), first, end);
    case StageKind::velocities:
      return for_staged(bodies_.constants(), first, end, [&](std::uint32_t number) {
        bodies_.integrate_velocity(stage.substep == 0, number);
      });
    case StageKind::note_pushes:
      return warm_start_.gain_limit().note_pushes(first, end);
    case StageKind::limit_repeats:
    case StageKind::limit_gains:
      return warm_start_.gain_limit().limit_gains(constraints_.run());
    case StageKind::warm_joints:
      return joints.warm_start(joints_.run(), first, end);
    case StageKind::first_impacts:
      return impacts_.run(bodies_.before());
    case StageKind::solve:
      return constraints_.solve(stage.color, first, end);
    case StageKind::push_islands:
    case StageKind::relax_islands:
      return converged_->islands.for_staged(first, end, [&](std::uint32_t island) {
        converged_->islands.solve(constraints_.run(), joints_, island,
                                  stage.kind == StageKind::push_islands);
      });
    case StageKind::solve_balls:
      return joints_.balls().solve_positions(joints_.balls_run(), stage.color, first, end);
    case StageKind::solve_joints:
      return joints.solve(joints_.run(), first, end);
    case StageKind::positions:  // bodies without contacts have joints, which move them
      return for_staged(bodies_.constants(), first,
                        std::min<std::size_t>(end, joints_.first_without_contacts()),
                        [this](std::uint32_t number) { bodies_.integrate_position(number); });
    case StageKind::move_joined:
      return joints.move(joints_.run(), first, end);
    case StageKind::relax_joints:
      return joints.relax(joints_.run(), first, end);
    case StageKind::update_balls:
      return joints_.balls().update(joints_.balls_run(), stage.color, first, end);
    case StageKind::impacts:
      return impacts_.run(bodies_.rows());
    case StageKind::relax:
      return constraints_.relax(stage.color, first, end, tick_.first_substep + stage.substep);
    case StageKind::note_impulses:
      return totals_.note(constraints_.run());
    case StageKind::whole_islands:
      return converged_->whole.solve(first, end);
    case StageKind::end_islands:
      return converged_->islands.for_staged(first, end, [this](std::uint32_t island) {
        converged_->islands.end(constraints_.run(), island);
      });
    case StageKind::end_joints:
      return joints.end(joints_.run());
    case StageKind::keep_speeds:
      return bounce_limit_.keep_speeds(first, end);
    default:
      LKS_ASSERT(stage.kind == StageKind::bounce);
      return constraints_.bounce(stage.color, first, end);
  }
}

void ContactSolver::store(std::span<const Manifold> manifolds, std::span<ContactRecord> records,
                          std::span<SolverVelocity> approaches, Parallel& parallel) {
  if (tick_.is_idle) return;
  LKS_ASSERT(approaches.size() >= records.size());
  warm_start_.store(records);
  schedule_.plan_store(work());
  const ContactConstraints::StoreTarget target{manifolds, records, approaches};
  std::atomic<std::uint32_t> saturations{0};
  schedule_.run(parallel, [&](const Stage& stage, std::size_t first, std::size_t end) {
    saturations.fetch_add(constraints_.store(stage.color, first, end, target, motion_),
                          std::memory_order_relaxed);
  });
  tick_.saturations = saturations;
  if (converged_ != nullptr) converged_->islands.forget(contacts_, records);
}

const SolverBody* ContactSolver::find(std::uint32_t body) const {
  const std::uint32_t number = bodies_.number_of(body);
  return number == 0 ? nullptr : &bodies_.constants()[number];
}

std::uint32_t ContactSolver::move(const SolverBody& solved, const Mat3& rotation,
                                  BodyRecord& body) {
  const std::uint32_t number = number_of(solved);
  LKS_ASSERT(number > 0 && number < bodies_.count());
  const JointPose* pose = joints_.solver().find(bodies_.side(number).body());
  if (!constraints_.has_restitution() || !body.is_dynamic())
    return motion_.scatter(number, rotation, pose, body);
  LKS_ASSERT(body.is_dynamic() && bodies_.side(number).is_dynamic());
  const BodyRecord start = body;
  const std::uint32_t turns = motion_.scatter(number, rotation, pose, body);
  bounce_limit_.note_gain(number, body, start);
  return turns;
}

void ContactSolver::limit_bounces(std::span<BodyRecord> bodies, Velocity speed_limit) {
  if (constraints_.has_restitution()) bounce_limit_.limit(bodies, speed_limit);
}

bool ContactSolver::keeps_recycling_pose(const IslandTally* island, const BodyRecord& record,
                                         Length inner_radius) {
  if (island == nullptr || island->is_converged) return false;
  if (!island->may_be_loose()) return is_near_recycling_pose(record, coarse_range(record));
  // A sweeper may have taken the body along since it was counted.
  const bool is_quiet = island->strayed.get() == 0;
  return is_near_recycling_pose(record,
                                is_quiet ? wide_range(record) : pile_range(record, inner_radius));
}

void ContactSolver::note_motion(std::uint32_t body, const BodyRecord& record,
                                const BodyMotion& motion) {
  LKS_ASSERT(motion.has_moved || !motion.has_travelled);
  if (!motion.has_moved && motion.is_settled) return;
  const std::uint32_t number = bodies_.number_of(body);
  const std::uint32_t island = number == 0 ? 0 : islands_.of(BodyRef::numbered(number));
  if (island == 0) return;
  IslandTally& tally = islands_.tally(island);
  if (motion.has_travelled)
    tally.travelled.raise();
  else if (!motion.is_settled)
    tally.unsettled.raise();
  if (!motion.has_moved) return;
  tally.moved.raise();
  if (tally.may_be_loose() && !is_near_recycling_pose(record, wide_range(record)))
    tally.strayed.raise();
}

EnergyLimit::Bodies ContactSolver::energy_bodies() {
  return {bodies_, islands_.all(), joints_.solver()};
}

SolverCounts ContactSolver::counts() const {
  const ConstraintGraph& graph = constraints_.layout().graph();
  SolverCounts counts{contacts_.size(),
                      constraints_.points(),
                      graph.colors(),
                      graph.count(k_overflow_color),
                      tick_.saturations,
                      energy_limit_.count() + joints_.solver().energy_limits(),
                      joints_.solver().pool_use()};
  LKS_ASSERT(graph.count(k_overflow_color) <= contacts_.size());
  if (converged_ != nullptr && converged_->islands.pool().was_full()) counts.pools.note_exhausted();
  return counts;
}

void ContactSolver::list_shares(std::vector<IslandShare>& to) const {
  to.clear();
  if (converged_ == nullptr || tick_.is_idle) return;
  const IslandPool& pool = converged_->islands.pool();
  LKS_ASSERT(is_reserved(to, pool.count()));
  for (std::uint32_t island = 0; island < pool.count(); ++island) {
    LKS_ASSERT(pool.first_body(island) != 0);
    to.push_back({bodies_.side(pool.first_body(island)).body(), pool.share(island)});
  }
}

PoolShare ContactSolver::room() const {
  return converged_ == nullptr ? PoolShare{} : converged_->islands.pool().room();
}

}  // namespace lockstone
