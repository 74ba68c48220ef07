#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/bench/baselines/solvers/methods.h"

namespace lockstone::bench::trial {
namespace {

constexpr double k_gravity = 9.81;
constexpr double k_bounce_speed = 1;  // m/s

double coupling(const Row& x, const Row& y) {
  return dot(x.ja, y.ja) + dot(x.jb, y.jb);
}

}  // namespace

SoftSteps::Softness SoftSteps::softness(double hertz, double damping) const {
  const double omega = 2 * std::numbers::pi * std::min(hertz, 0.25 / h_);
  const double sum = 2 * damping + h_ * omega, scale = h_ * omega * sum;
  return {omega / sum, scale / (1 + scale), 1 / (1 + scale)};
}

// The compliance of a contact falls with its load, so that no contact sinks deeper than one that
// carries the lighter body alone.
SoftSteps::Softness SoftSteps::stiffened(Softness soft, const Row& row) const {
  const double load = options_.stiffen * row.impulse * row.weight / (k_gravity * h_);
  if (load <= 1) return soft;
  const double give = soft.impulse_scale / soft.mass_scale / load;
  return {soft.bias_rate, 1 / (1 + give), give / (1 + give)};
}

// Rows of a joint that are solved as one block: three of position, or all of the rotation.
void SoftSteps::make_groups() {
  groups_.clear();
  const std::vector<Row>& rows = problem_.rows;
  for (std::size_t i = problem_.contact_rows; i < rows.size();) {
    std::size_t end = i + 1;
    const auto alike = [&](const Row& r) {
      return r.kind == RowKind::bilateral && rows[i].kind == r.kind && r.source == rows[i].source &&
             r.rotational == rows[i].rotational;
    };
    while (end < rows.size() && alike(rows[end]))
      ++end;
    groups_.emplace_back(i, end - i);
    i = end;
  }
}

void SoftSteps::solve_group(std::size_t first, std::size_t count, bool bias) {
  Row* rows = &problem_.rows[first];
  if (rows[0].kind != RowKind::bilateral) return solve_drive(rows[0], bias);
  const Softness soft = bias ? softness(options_.joint_hertz, options_.joint_damping) : Softness{};
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, r[3] = {};
  for (std::size_t i = 0; i < count; ++i) {
    r[i] = -speed(problem_, rows[i]) - (bias ? soft.bias_rate * rows[i].error : 0);
    for (std::size_t k = 0; k < count; ++k)
      m[i][k] = coupling(rows[i], rows[k]);
  }
  const Mat3 matrix{
      {m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}};
  const Vec3 x = inverse(matrix) * Vec3{r[0], r[1], r[2]};
  const double parts[3] = {x.x, x.y, x.z};
  for (std::size_t i = 0; i < count; ++i) {
    Row& row = rows[i];
    const double pull = row.impulse - options_.carry * row.centre;
    const double change = soft.mass_scale * parts[i] - soft.impulse_scale * pull;
    row.impulse += change;
    apply(problem_, row, change);
  }
}

void SoftSteps::solve_drive(Row& row, bool bias) {
  double give = row.give, push = row.bias;
  if (row.kind == RowKind::limit) {
    const Softness soft = softness(options_.joint_hertz, options_.joint_damping);
    const bool over = row.error < 0 && bias;
    push = row.error > 0 ? row.error / h_ : over ? soft.bias_rate * row.error : 0;
    give = over ? row.weight * soft.impulse_scale / soft.mass_scale : 0;
  }
  double next =
      row.impulse - (speed(problem_, row) + push + give * row.impulse) / (row.weight + give);
  if (row.kind == RowKind::limit) next = std::max(next, 0.0);
  if (row.kind == RowKind::motor) next = std::clamp(next, -row.limit, row.limit);
  apply(problem_, row, next - row.impulse);
  row.impulse = next;
}

void SoftSteps::solve_contact(std::size_t index, bool bias) {
  Row *u = &problem_.rows[index + 1], *w = &problem_.rows[index + 2];
  const double old_u = u->impulse, old_w = w->impulse;
  const double su = speed(problem_, *u), sw = speed(problem_, *w);
  u->impulse -= su / u->step;
  w->impulse -= sw / w->step;
  project_on_cone(problem_, index + 1);
  apply(problem_, *u, u->impulse - old_u);
  apply(problem_, *w, w->impulse - old_w);
  Row& n = problem_.rows[index];
  Contact& contact = system_.contacts[n.source];
  const double gap = separation(system_, contact);
  Softness soft;
  double push = 0;
  if (gap > 0) {
    push = gap / h_;
  } else if (bias) {
    const bool on_fixed = n.a < 0 || n.b < 0;
    soft = softness((on_fixed ? 2 : 1) * options_.contact_hertz, options_.contact_damping);
    soft = stiffened(soft, n);
    push = std::max(soft.bias_rate * gap, -options_.push);
  }
  const double pull = n.impulse - options_.carry * n.centre;
  const double change =
      -soft.mass_scale * (speed(problem_, n) + push) / n.weight - soft.impulse_scale * pull;
  const double next = std::max(n.impulse + change, 0.0);
  apply(problem_, n, next - n.impulse);
  n.impulse = next;
  contact.peak = std::max(contact.peak, next);
}

void SoftSteps::pass(bool bias) {
  for (const auto& [first, count] : groups_)
    solve_group(first, count, bias);
  for (int i = 0; i < problem_.contact_rows; i += 3)
    solve_contact(i, bias);
}

void SoftSteps::substep() {
  for (const int body : problem_.bodies)
    system_.bodies[body].velocity = system_.bodies[body].velocity + h_ * system_.gravity;
  if (!problem_.joints.empty()) refresh(system_, h_, problem_);
  gather(system_, problem_);
  make_groups();
  for (Row& row : problem_.rows) {
    row.centre = std::max(0.0, row.impulse - options_.soft_leak * k_gravity * h_ / row.weight);
    if (row.kind != RowKind::normal) row.centre = row.impulse;
    if (row.kind == RowKind::motor || row.kind == RowKind::spring)
      set_drive(row, system_.joints[row.source], h_);
    apply(problem_, row, row.impulse);
  }
  for (int i = 0; i < options_.iterations; ++i)
    pass(true);
  scatter(system_, problem_);
  for (const int body : problem_.bodies)
    move(system_.bodies[body], h_);
  gather(system_, problem_);
  for (int i = 0; i < options_.relaxations; ++i)
    pass(false);
  scatter(system_, problem_);
}

void SoftSteps::restitution() {
  gather(system_, problem_);
  for (int i = 0; i < problem_.contact_rows; i += 3) {
    Row& n = problem_.rows[i];
    const Contact& contact = system_.contacts[n.source];
    if (contact.restitution == 0 || contact.approach > -k_bounce_speed || contact.peak == 0)
      continue;
    const double wanted = -contact.restitution * contact.approach;
    const double next = std::max(0.0, n.impulse - (speed(problem_, n) - wanted) / n.weight);
    apply(problem_, n, next - n.impulse);
    n.impulse = next;
  }
  scatter(system_, problem_);
}

}  // namespace lockstone::bench::trial
