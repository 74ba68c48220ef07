#include <algorithm>
#include <cmath>

#include "tools/bench/baselines/solvers/methods.h"

namespace lockstone::bench::trial {
namespace {

constexpr double k_far = 0.005;     // m or rad: beyond it a joint is drawn in slowly
constexpr double k_draw_in = 0.44;  // of the error a substep
constexpr double k_closing = 4;     // m/s: fastest
constexpr double k_gravity = 9.81;

double rounded(double x, int bits) {
  return std::ldexp(std::nearbyint(std::ldexp(x, bits)), -bits);
}

bool is_proximal(const Row& row) {
  return row.kind == RowKind::bilateral || row.kind == RowKind::motor;
}

}  // namespace

Proximal::Proximal(System& system, Problem& problem, BlockFactor& factor, const Options& options,
                   double h, Counts& counts)
    : system_(system),
      problem_(problem),
      factor_(factor),
      options_(options),
      h_(h),
      counts_(counts),
      jointed_(!problem.joints.empty()) {
  std::vector<std::pair<int, int>> pairs;
  for (const Row& row : problem.rows)
    if (row.a >= 0 && row.b >= 0)
      pairs.emplace_back(std::min(row.a, row.b), std::max(row.a, row.b));
  factor_.analyse(static_cast<int>(problem.bodies.size()), std::move(pairs));
  set_gives();
  for (const int body : problem.bodies)
    mass_ += system.bodies[body].mass;
  counts_.blocks = std::max<long>(counts_.blocks, factor_.blocks());
}

// Once a tick, so that factors stay: contacts that carry many times the lighter body give less, by
// powers of two.
void Proximal::set_gives() {
  for (int i = 0; i < problem_.contact_rows; i += 3) {
    Row* rows = &problem_.rows[i];
    const double load = rows->impulse * rows->weight / (k_gravity * h_ * options_.overload);
    const double share = std::exp2(-std::clamp(std::floor(std::log2(load + 1e-9)), 0.0, 4.0));
    const double give = options_.give * share * std::max(rows[0].weight, rows[1].step);
    for (int k = 0; k < 3; ++k)
      rows[k].give = give;
  }
}

// The values that the substep's impulses are pulled towards, and the strengths of the pull.
void Proximal::set_centres() {
  for (std::size_t i = 0; i < problem_.rows.size(); ++i) {
    Row& row = problem_.rows[i];
    if (i >= static_cast<std::size_t>(problem_.contact_rows))
      row.give = options_.joint_give * row.weight;
    row.centre = row.impulse;
    if (row.kind == RowKind::normal || row.kind == RowKind::limit) {
      const double weight_impulse = k_gravity * h_ / row.weight;
      row.centre -=
          std::min((1 - options_.keep_normal) * row.impulse, options_.leak * weight_impulse);
    }
    if (row.kind == RowKind::tangent) row.centre *= options_.keep_tangent;
    if (row.kind != RowKind::spring) continue;
    set_drive(row, system_.joints[row.source], h_);
    row.centre = 0;
  }
}

// D(θ λ) least: kinetic energy after the warm start is at most that of the free motion.
void Proximal::scale_warm_start() {
  std::vector<Vec6> sum(problem_.bodies.size(), Vec6{});
  double slope = 0, curve = 0;
  for (const Row& row : problem_.rows) {
    const double gap =
        row.kind == RowKind::normal ? separation(system_, system_.contacts[row.source]) : 0;
    slope += row.impulse * (speed(problem_, row) + std::max(gap, 0.0) / h_);
    if (row.a >= 0) add(sum[row.a], row.ja, row.impulse);
    if (row.b >= 0) add(sum[row.b], row.jb, row.impulse);
  }
  for (const Vec6& u : sum)
    curve += dot(u, u);
  const double scale =
      curve > 0 && options_.scale_warm_start ? std::clamp(-slope / curve, 0.0, 1.0) : 1;
  for (Row& row : problem_.rows)
    row.impulse *= scale;
  for (std::size_t i = 0; i < sum.size(); ++i)
    add(problem_.velocity[i], sum[i], scale);
}

void Proximal::set_biases(bool bias) {
  for (Row& row : problem_.rows) {
    if (row.kind == RowKind::motor) row.bias = -row.target;
    if (row.kind == RowKind::bilateral)
      row.bias = bias ? std::clamp(k_draw_in * row.error / h_, -k_closing, k_closing) : 0;
    if (row.kind != RowKind::normal && row.kind != RowKind::limit) continue;
    const double gap =
        row.kind == RowKind::limit ? row.error : separation(system_, system_.contacts[row.source]);
    const double out = bias ? std::max(options_.beta * gap, -options_.push) : 0;
    row.bias = gap > 0 ? gap / h_ : out;
  }
  if (bias && jointed_ && options_.nonlinear) set_joint_errors();
}

// Joint errors at the poses that the present velocities lead to.
void Proximal::set_joint_errors() {
  scatter(system_, problem_);
  std::vector<Body> start;
  for (const int body : problem_.bodies) {
    start.push_back(system_.bodies[body]);
    move(system_.bodies[body], h_);
  }
  std::vector<Row> after;
  for (const int joint : problem_.joints)
    append_joint_rows(system_, joint, h_, after);
  for (std::size_t i = 0; i < start.size(); ++i)
    system_.bodies[problem_.bodies[i]] = start[i];
  for (std::size_t i = 0; i < after.size(); ++i) {
    Row& row = problem_.rows[problem_.contact_rows + i];
    if (row.kind != RowKind::bilateral || std::fabs(row.error) > k_far) continue;
    row.bias = after[i].error / h_ - speed(problem_, row);
  }
}

double Proximal::sweep_one(std::size_t index) {
  Row& row = problem_.rows[index];
  const double wanted = speed(problem_, row) + row.bias + row.give * (row.impulse - row.centre);
  double next = row.impulse - wanted / (row.weight + row.give);
  if (row.kind == RowKind::normal || row.kind == RowKind::limit) next = std::max(next, 0.0);
  if (row.kind == RowKind::motor) next = std::clamp(next, -row.limit, row.limit);
  const double change = next - row.impulse;
  row.impulse = next;
  apply(problem_, row, change);
  return std::fabs(change) * row.weight;
}

// Returns the greatest change of a velocity.
double Proximal::sweep() {
  double greatest = 0;
  ++counts_.sweeps;
  for (std::size_t i = problem_.contact_rows; i < problem_.rows.size(); ++i)
    greatest = std::max(greatest, sweep_one(i));
  for (int i = 0; i < problem_.contact_rows; i += 3) {
    greatest = std::max(greatest, sweep_one(i));
    Row* rows[2] = {&problem_.rows[i + 1], &problem_.rows[i + 2]};
    const double old[2] = {rows[0]->impulse, rows[1]->impulse};
    double wanted[2];
    for (int k = 0; k < 2; ++k)
      wanted[k] = speed(problem_, *rows[k]) + rows[k]->give * (old[k] - rows[k]->centre);
    for (int k = 0; k < 2; ++k)
      rows[k]->impulse -= wanted[k] / (rows[k]->step + rows[k]->give);
    project_on_cone(problem_, i + 1);
    for (int k = 0; k < 2; ++k) {
      const double change = rows[k]->impulse - old[k];
      apply(problem_, *rows[k], change);
      greatest = std::max(greatest, std::fabs(change) * rows[k]->weight);
    }
  }
  return greatest;
}

void Proximal::mark_active() {
  for (Row& row : problem_.rows) {
    if (is_proximal(row)) row.centre = row.impulse;
    row.active = true;
    if (row.kind == RowKind::motor) row.active = std::fabs(row.impulse) < row.limit;
    if (row.kind == RowKind::normal || row.kind == RowKind::limit) row.active = row.impulse > 0;
  }
  for (int i = 0; i < problem_.contact_rows; i += 3) {
    Row &n = problem_.rows[i], &u = problem_.rows[i + 1], &w = problem_.rows[i + 2];
    const double most = n.friction * n.impulse * (1 - 1e-9);
    u.active = w.active = n.active && std::hypot(u.impulse, w.impulse) < most;
  }
}

void Proximal::factor() {
  std::vector<char> active;
  for (const Row& row : problem_.rows)
    active.push_back(row.active ? 1 : 0);
  if (options_.reuse && active == factored_) return;
  factor_.set_identity();
  for (const Row& row : problem_.rows)
    if (row.active) factor_.add_row(row.a, row.b, row.ja, row.jb, 1 / row.give);
  factor_.factor(options_.round_factor);
  factored_ = std::move(active);
  ++counts_.factors;
  counts_.least_pivot = std::min(counts_.least_pivot, factor_.least_pivot());
  counts_.greatest_pivot = std::max(counts_.greatest_pivot, factor_.greatest_pivot());
}

void Proximal::candidate(const std::vector<Vec6>& change, std::vector<double>& next) const {
  const std::vector<Row>& rows = problem_.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    next[i] = row.kind == RowKind::tangent || row.kind == RowKind::motor ? row.impulse : 0;
    if (!row.active) continue;
    const double moved = (row.a >= 0 ? dot(row.ja, change[row.a]) : 0) +
                         (row.b >= 0 ? dot(row.jb, change[row.b]) : 0);
    next[i] = row.impulse - (residual_[i] + moved) / row.give;
    if (row.kind == RowKind::normal || row.kind == RowKind::limit) next[i] = std::max(next[i], 0.0);
    if (row.kind == RowKind::motor) next[i] = std::clamp(next[i], -row.limit, row.limit);
  }
  for (int i = 0; i < problem_.contact_rows; i += 3) {
    const double most = rows[i].friction * next[i], size = std::hypot(next[i + 1], next[i + 2]);
    if (size <= most) continue;
    next[i + 1] *= most / size;
    next[i + 2] *= most / size;
  }
}

// Goes from the present impulses towards `next` as far as the dual falls; returns how far.
double Proximal::search(const std::vector<double>& next) {
  std::vector<Vec6> sum(problem_.bodies.size(), Vec6{});
  double slope = 0, curve = 0;
  for (std::size_t i = 0; i < next.size(); ++i) {
    const Row& row = problem_.rows[i];
    const double change = next[i] - row.impulse;
    slope += change * residual_[i];
    curve += row.give * change * change;
    if (row.a >= 0) add(sum[row.a], row.ja, change);
    if (row.b >= 0) add(sum[row.b], row.jb, change);
  }
  for (const Vec6& u : sum)
    curve += dot(u, u);
  const double part = curve > 0 ? std::clamp(-slope / curve, 0.0, 1.0) : 0;
  for (std::size_t i = 0; i < next.size(); ++i)
    problem_.rows[i].impulse += part * (next[i] - problem_.rows[i].impulse);
  for (std::size_t i = 0; i < sum.size(); ++i)
    add(problem_.velocity[i], sum[i], part);
  gain_ = -part * (slope + part * curve / 2);
  return part;
}

bool Proximal::direct_step() {
  ++counts_.direct_steps;
  mark_active();
  factor();
  const std::size_t count = problem_.rows.size();
  residual_.resize(count);
  std::vector<Vec6> change(problem_.bodies.size(), Vec6{});
  for (std::size_t i = 0; i < count; ++i) {
    const Row& row = problem_.rows[i];
    residual_[i] = speed(problem_, row) + row.bias + row.give * (row.impulse - row.centre);
    if (!row.active) continue;
    if (row.a >= 0) add(change[row.a], row.ja, -residual_[i] / row.give);
    if (row.b >= 0) add(change[row.b], row.jb, -residual_[i] / row.give);
  }
  factor_.solve(change);
  std::vector<double> next(count);
  candidate(change, next);
  const double least = options_.least_gain * mass_ * 9.81 * 9.81 * h_ * h_ / 2;
  return search(next) > 0 && gain_ > least;
}

void Proximal::phase(bool bias) {
  ++counts_.phases;
  set_biases(bias);
  for (int step = 0;; ++step) {
    double change = 0;
    const int most = step == 0 ? options_.first_sweeps : options_.sweeps;
    for (int i = 0; i < most; ++i)
      if ((change = sweep()) < options_.tolerance) break;
    const bool done = change < options_.tolerance && (!jointed_ || step >= options_.joint_steps);
    if (!done && step >= options_.newton) ++counts_.unconverged;
    if (done || step >= options_.newton) break;
    if (step > 0 && bias && jointed_ && options_.nonlinear) set_joint_errors();
    if (!direct_step() && !jointed_) break;
  }
}

// Geometric stiffness of ball joints: their last forces turn with the bodies.
void Proximal::stiffen() {
  const std::size_t count = problem_.bodies.size();
  std::vector<Mat3> sums(count, Mat3{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto add_side = [&](int unknown, const Vec3& arm, const Vec3& force) {
    if (unknown < 0) return;
    Mat3& k = sums[unknown];
    const double d = dot(arm, force);
    k.x = k.x + force.x * arm - Vec3{d, 0, 0};
    k.y = k.y + force.y * arm - Vec3{0, d, 0};
    k.z = k.z + force.z * arm - Vec3{0, 0, d};
  };
  for (std::size_t i = problem_.contact_rows; i < problem_.rows.size(); ++i) {
    const Row& row = problem_.rows[i];
    const Joint& joint = system_.joints[row.source];
    if (row.kind != RowKind::bilateral || row.rotational || joint.kind == JointKind::slider)
      continue;
    const Vec3 force = (row.impulse / h_) * row.linear;
    add_side(row.a, system_.bodies[joint.a].to_world(joint.anchor_a), -force);
    add_side(row.b, system_.bodies[joint.b].to_world(joint.anchor_b), force);
  }
  for (std::size_t i = 0; i < count; ++i) {
    Body& body = system_.bodies[problem_.bodies[i]];
    const auto excess = [&](const Vec3& column, double moment) {
      return std::max(0.0, h_ * h_ * length(column) - 2 * moment);
    };
    const Vec3 d{excess(sums[i].x, body.inertia.x.x), excess(sums[i].y, body.inertia.y.y),
                 excess(sums[i].z, body.inertia.z.z)};
    problem_.stiffening[i] = d;
    if (d.x + d.y + d.z == 0) continue;
    Mat3 inertia = body.inertia;
    inertia.x.x += d.x;
    inertia.y.y += d.y;
    inertia.z.z += d.z;
    body.spin = inverse(inertia) * (body.inertia * body.spin);
  }
}

void Proximal::round_impulses() {
  if (options_.round_impulse == 0) return;
  for (Row& row : problem_.rows)
    row.impulse = rounded(row.impulse * row.weight, options_.round_impulse) / row.weight;
}

void Proximal::fall(double seconds) {
  for (const int body : problem_.bodies)
    system_.bodies[body].velocity = system_.bodies[body].velocity + seconds * system_.gravity;
}

// Without contacts gravity acts half before and half after the move, so that energy is that of the
// substep's end; a body that rests on a contact needs all of it in the first phase.
void Proximal::substep() {
  const double first = options_.half_kick && problem_.contact_rows == 0 ? h_ / 2 : h_;
  fall(first);
  if (jointed_) {
    if (options_.geometric) stiffen();
    refresh(system_, h_, problem_);
    factored_.clear();
  }
  gather(system_, problem_);
  set_centres();
  scale_warm_start();
  phase(true);
  scatter(system_, problem_);
  for (const int body : problem_.bodies)
    move(system_.bodies[body], h_);
  if (jointed_) {
    problem_.stiffening.assign(problem_.bodies.size(), {});
    std::vector<Row> before = problem_.rows;
    refresh(system_, h_, problem_);
    for (std::size_t i = problem_.contact_rows; i < before.size(); ++i) {
      problem_.rows[i].give = before[i].give;
      if (before[i].kind == RowKind::spring) problem_.rows[i].bias = before[i].bias;
    }
    factored_.clear();
  }
  fall(h_ - first);
  gather(system_, problem_);
  phase(false);
  round_impulses();
  scatter(system_, problem_);
}

}  // namespace lockstone::bench::trial
