#include <algorithm>
#include <cmath>

#include "tools/bench/baselines/solvers/methods.h"

namespace lockstone::bench::trial {
namespace {

constexpr double k_stiffest = 1e12;

void solve(Mat6 m, Vec6& x) {
  for (int j = 0; j < 6; ++j)
    for (int i = j + 1; i < 6; ++i) {
      const double ratio = m[i * 6 + j] / m[j * 7];
      for (int k = j; k < 6; ++k)
        m[i * 6 + k] -= ratio * m[j * 6 + k];
      x[i] -= ratio * x[j];
    }
  for (int i = 5; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k)
      x[i] -= m[i * 6 + k] * x[k];
    x[i] /= m[i * 7];
  }
}

}  // namespace

Descent::Descent(System& system, Problem& problem, const Options& options, double h)
    : system_(system),
      problem_(problem),
      options_(options),
      h_(h),
      rows_of_(problem.bodies.size()) {
  for (std::size_t i = 0; i < problem.rows.size(); ++i)
    for (const int side : {problem.rows[i].a, problem.rows[i].b})
      if (side >= 0) rows_of_[side].push_back(static_cast<int>(i));
  for (const Row& row : problem.rows) {
    const bool contact = row.kind == RowKind::normal || row.kind == RowKind::tangent;
    stiffness_.push_back(contact ? system.contacts[row.source].stiffness[row.slot]
                                 : system.joints[row.source].stiffness[row.slot]);
  }
}

Vec6 Descent::shift(int unknown, const Pose& from) const {
  const Body& body = system_.bodies[problem_.bodies[unknown]];
  const Vec3 way = std::sqrt(body.mass) * (body.position - from.position);
  const Vec3 turn = transposed(problem_.root[unknown]) *
                    rotation_vector(body.rotation * conjugate(from.rotation));
  return {way.x, way.y, way.z, turn.x, turn.y, turn.z};
}

// The error that is left now: of contacts linear from the substep's start, of joints from the
// iteration's.
double Descent::error(const Row& row) const {
  const bool contact = row.kind == RowKind::normal || row.kind == RowKind::tangent;
  double sum = row.error;
  const auto add_side = [&](int unknown, const Vec6& j) {
    if (unknown < 0) return;
    sum += dot(j, moved_[unknown]);
    if (!contact) sum -= dot(j, base_[unknown]);
  };
  add_side(row.a, row.ja);
  add_side(row.b, row.jb);
  return sum;
}

double Descent::pull(std::size_t index) const {
  const Row& row = problem_.rows[index];
  const double part = row.kind == RowKind::bilateral ? options_.forget_impulse : 1;
  const double kept =
      row.kind == RowKind::bilateral || row.kind == RowKind::motor ? part * start_error_[index] : 0;
  return row.impulse - stiffness_[index] * (error(row) - kept) - row.bias;
}

double Descent::force(std::size_t index) const {
  const Row& row = problem_.rows[index];
  const double f = pull(index);
  if (row.kind == RowKind::normal || row.kind == RowKind::limit) return std::max(f, 0.0);
  if (row.kind == RowKind::motor) return std::clamp(f, -row.limit / h_, row.limit / h_);
  if (row.kind != RowKind::tangent) return f;
  const std::size_t other = row.slot == 1 ? index + 1 : index - 1;
  const double most = row.friction * problem_.rows[row.normal].impulse;
  const double size = std::hypot(f, pull(other));
  return size > most ? f * most / size : f;
}

void Descent::begin_row(Row& row) {
  const std::size_t index = &row - problem_.rows.data();
  const double unit = 1 / (h_ * h_ * row.weight);
  row.impulse *= options_.forget_impulse * options_.forget_stiffness / h_;
  stiffness_[index] = std::clamp(stiffness_[index] * options_.forget_stiffness,
                                 options_.least_stiffness * unit, k_stiffest);
  row.bias = 0;
  if (row.kind == RowKind::normal) {
    const double gap = separation(system_, system_.contacts[row.source]);
    row.error = gap > 0 ? gap : gap * (1 - options_.forget_impulse);
  }
  if (row.kind == RowKind::motor) row.error = 0;
  start_error_[index] = row.kind == RowKind::motor ? row.target * h_ : row.error;
  if (row.kind != RowKind::spring) return;
  const Joint& joint = system_.joints[row.source];
  const double rate = joint.spring_rate;
  row.impulse = 0;
  stiffness_[index] = rate * (rate + 2 * joint.spring_damping / h_) / row.weight;
  row.bias = -2 * joint.spring_damping * rate / h_ * row.error / row.weight;
}

void Descent::begin() {
  if (!problem_.joints.empty()) refresh(system_, h_, problem_);
  start_error_.assign(problem_.rows.size(), 0);
  for (Row& row : problem_.rows)
    begin_row(row);
  start_.clear();
  for (const int body : problem_.bodies)
    start_.push_back({system_.bodies[body].position, system_.bodies[body].rotation});
}

void Descent::predict() {
  const double g = length(system_.gravity);
  const std::size_t count = problem_.bodies.size();
  inertial_.resize(count);
  moved_.resize(count);
  base_.assign(count, Vec6{});
  for (std::size_t i = 0; i < count; ++i) {
    Body& body = system_.bodies[problem_.bodies[i]];
    const Vec3 gained = (1 / h_) * (body.velocity - body.previous_velocity);
    const double part = g > 0 ? std::clamp(dot(gained, system_.gravity) / (g * g), 0.0, 1.0) : 0;
    body.rotation = normalized(rotation(h_ * body.spin) * body.rotation);
    const Vec3 start = body.position;
    body.position = start + h_ * body.velocity + (h_ * h_) * system_.gravity;
    inertial_[i] = shift(static_cast<int>(i), start_[i]);
    body.position = start + h_ * body.velocity + (part * h_ * h_) * system_.gravity;
    moved_[i] = shift(static_cast<int>(i), start_[i]);
    update(body);
  }
}

void Descent::refresh_joints() {
  if (problem_.joints.empty()) return;
  for (const int body : problem_.bodies)
    update(system_.bodies[body]);
  std::vector<Row> now;
  for (const int joint : problem_.joints)
    append_joint_rows(system_, joint, h_, now);
  base_ = moved_;
  for (std::size_t i = 0; i < now.size(); ++i) {
    Row& row = problem_.rows[problem_.contact_rows + i];
    if (row.kind == RowKind::motor) {
      row.error = 0;
      for (const auto& [unknown, j] : {std::pair(row.a, row.ja), std::pair(row.b, row.jb)})
        if (unknown >= 0) row.error += dot(j, moved_[unknown]);
      continue;
    }
    row.error = now[i].error;
    row.linear = now[i].linear;
    row.angular_a = now[i].angular_a;
    row.angular_b = now[i].angular_b;
  }
  normalise_rows(system_, problem_);
}

void Descent::descend(int unknown) {
  const double inertia = 1 / (h_ * h_);
  Mat6 matrix{};
  Vec6 step{};
  for (int i = 0; i < 6; ++i) {
    matrix[i * 7] = inertia;
    step[i] = -inertia * (moved_[unknown][i] - inertial_[unknown][i]);
  }
  for (const int index : rows_of_[unknown]) {
    const Row& row = problem_.rows[index];
    const Vec6& j = row.a == unknown ? row.ja : row.jb;
    add(step, j, force(index));
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 6; ++k)
        matrix[i * 6 + k] += stiffness_[index] * j[i] * j[k];
  }
  solve(matrix, step);
  add(moved_[unknown], step, 1);
  Body& body = system_.bodies[problem_.bodies[unknown]];
  const Vec6& m = moved_[unknown];
  body.position = start_[unknown].position + (1 / std::sqrt(body.mass)) * Vec3{m[0], m[1], m[2]};
  const Vec3 turn = transposed(problem_.inverse_root[unknown]) * Vec3{m[3], m[4], m[5]};
  body.rotation = normalized(rotation(turn) * start_[unknown].rotation);
}

void Descent::update_dual(std::size_t index) {
  Row& row = problem_.rows[index];
  if (row.kind == RowKind::spring) return;
  const double f = force(index), free = pull(index);
  const double left =
      std::fabs(f - free) > 1e-12 * std::fabs(free) ? 0 : std::fabs(free - row.impulse);
  const double unit = 1 / (h_ * h_ * row.weight);
  const double moved = left / stiffness_[index];
  if (f != 0 || row.kind == RowKind::bilateral)
    stiffness_[index] = std::min(stiffness_[index] + options_.ramp * unit * moved, k_stiffest);
  row.impulse = f;
}

void Descent::finish() {
  for (std::size_t i = 0; i < problem_.bodies.size(); ++i) {
    Body& body = system_.bodies[problem_.bodies[i]];
    body.previous_velocity = body.velocity;
    body.velocity = (1 / h_) * (body.position - start_[i].position);
    body.spin = (1 / h_) * rotation_vector(body.rotation * conjugate(start_[i].rotation));
    update(body);
  }
  for (std::size_t i = 0; i < problem_.rows.size(); ++i) {
    Row& row = problem_.rows[i];
    row.impulse *= h_;
    const bool contact = row.kind == RowKind::normal || row.kind == RowKind::tangent;
    (contact ? system_.contacts[row.source].stiffness[row.slot]
             : system_.joints[row.source].stiffness[row.slot]) = stiffness_[i];
  }
}

void Descent::substep() {
  begin();
  predict();
  for (int i = 0; i < options_.descents; ++i) {
    refresh_joints();
    for (std::size_t unknown = 0; unknown < problem_.bodies.size(); ++unknown)
      descend(static_cast<int>(unknown));
    for (std::size_t row = 0; row < problem_.rows.size(); ++row)
      update_dual(row);
  }
  finish();
}

}  // namespace lockstone::bench::trial
