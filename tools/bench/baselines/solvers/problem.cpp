#include "tools/bench/baselines/solvers/problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lockstone::bench::trial {
namespace {

// Lower triangle L with m = L Lᵀ, by columns.
Mat3 cholesky(const Mat3& m) {
  Mat3 l{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  l.x.x = std::sqrt(m.x.x);
  l.x.y = m.x.y / l.x.x;
  l.x.z = m.x.z / l.x.x;
  l.y.y = std::sqrt(m.y.y - l.x.y * l.x.y);
  l.y.z = (m.y.z - l.x.y * l.x.z) / l.y.y;
  l.z.z = std::sqrt(m.z.z - l.x.z * l.x.z - l.y.z * l.y.z);
  return l;
}

class Unions {
 public:
  explicit Unions(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

// Frames that the rows of one joint share.
struct Frames {
  const System& system;
  const Joint& joint;
  const Body &a, &b;
  Vec3 arm_a, arm_b, apart;
  Mat3 fa, fb;

  Frames(const System& s, int index)
      : system(s),
        joint(s.joints[index]),
        a(s.bodies[joint.a]),
        b(s.bodies[joint.b]),
        arm_a(a.to_world(joint.anchor_a)),
        arm_b(b.to_world(joint.anchor_b)),
        apart(b.position + arm_b - a.position - arm_a),
        fa(a.axes * joint.frame_a),
        fb(b.axes * joint.frame_b) {}

  [[nodiscard]] Row along(const Vec3& axis, double error) const {
    Row row;
    row.linear = axis;
    row.angular_a = -cross(arm_a, axis);
    row.angular_b = cross(arm_b, axis);
    row.error = error;
    return row;
  }
  [[nodiscard]] Row sliding(const Vec3& axis) const {
    Row row = along(axis, dot(apart, axis));
    row.angular_a = -cross(arm_a + apart, axis);
    return row;
  }
  [[nodiscard]] Row about(const Vec3& axis, double error) const {
    Row row;
    row.angular_a = -axis;
    row.angular_b = axis;
    row.error = error;
    row.rotational = 1;
    return row;
  }
  // u of A and w of B stay square to each other.
  [[nodiscard]] Row square(const Vec3& u, const Vec3& w) const {
    return about(cross(w, u), dot(u, w));
  }
  [[nodiscard]] bool slides() const { return joint.kind == JointKind::slider; }
  [[nodiscard]] double place() const {
    if (slides()) return dot(apart, fa.x);
    return std::atan2(dot(fb.y, fa.z), dot(fb.y, fa.y));
  }
  [[nodiscard]] Row drive() const { return slides() ? sliding(fa.x) : about(fa.x, place()); }
};

class JointRows {
 public:
  JointRows(const System& system, int index, double h, std::vector<Row>& rows)
      : frames_(system, index), index_(index), h_(h), rows_(rows) {}

  void append() {
    const JointKind kind = frames_.joint.kind;
    append_position();
    const Mat3 &fa = frames_.fa, &fb = frames_.fb;
    if (kind == JointKind::hinge) {
      push(frames_.square(fa.x, fb.y), 3);
      push(frames_.square(fa.x, fb.z), 4);
    }
    if (kind == JointKind::slider || kind == JointKind::weld) {
      push(frames_.square(fa.x, fb.y), 3);
      push(frames_.square(fa.y, fb.z), 4);
      push(frames_.square(fa.z, fb.x), 5);
    }
    append_drives();
  }

 private:
  void append_position() {
    if (frames_.slides()) {
      push(frames_.sliding(frames_.fa.y), 1);
      push(frames_.sliding(frames_.fa.z), 2);
      return;
    }
    push(frames_.along({1, 0, 0}, frames_.apart.x), 0);
    push(frames_.along({0, 1, 0}, frames_.apart.y), 1);
    push(frames_.along({0, 0, 1}, frames_.apart.z), 2);
  }

  void append_drives() {
    const Joint& joint = frames_.joint;
    if (joint.kind == JointKind::ball && joint.spring_rate > 0) return append_ball_spring();
    if (joint.motor) {
      Row row = frames_.drive();
      row.kind = RowKind::motor;
      row.target = joint.speed;
      row.limit = joint.max_effort * h_;
      push(row, 6);
    }
    if (joint.limited) append_limit();
    if (joint.spring_rate > 0 && !joint.motor) push_spring(frames_.drive(), 6);
  }

  void append_limit() {
    const Joint& joint = frames_.joint;
    Row row = frames_.drive();
    const double place = frames_.place();
    row.kind = RowKind::limit;
    row.error = place - joint.lower;
    if (joint.upper - place < row.error) {
      row.linear = -row.linear;
      row.angular_a = -row.angular_a;
      row.angular_b = -row.angular_b;
      row.error = joint.upper - place;
    }
    push(row, 7);
  }

  void append_ball_spring() {
    const Quat turn = frames_.b.rotation * conjugate(frames_.a.rotation);
    const Vec3 error = rotation_vector(turn);
    push_spring(frames_.about({1, 0, 0}, error.x), 3);
    push_spring(frames_.about({0, 1, 0}, error.y), 4);
    push_spring(frames_.about({0, 0, 1}, error.z), 5);
  }

  void push_spring(Row row, int slot) {
    row.kind = RowKind::spring;
    push(row, slot);
  }

  void push(Row row, int slot) {
    row.a = frames_.joint.a;
    row.b = frames_.joint.b;
    row.source = index_;
    row.slot = slot;
    row.impulse = frames_.joint.impulse[slot];
    rows_.push_back(row);
  }

  Frames frames_;
  int index_;
  double h_;
  std::vector<Row>& rows_;
};

void append_contact_rows(const System& system, int index, Problem& problem) {
  const Contact& c = system.contacts[index];
  const int first = static_cast<int>(problem.rows.size());
  const Vec3 axes[3] = {c.frame.x, c.frame.y, c.frame.z};
  for (int k = 0; k < 3; ++k) {
    Row row;
    row.kind = k == 0 ? RowKind::normal : RowKind::tangent;
    row.a = c.a;
    row.b = c.b;
    row.linear = axes[k];
    row.angular_a = -cross(c.arm_a, axes[k]);
    row.angular_b = cross(c.arm_b, axes[k]);
    row.impulse = c.impulse[k];
    row.friction = c.friction;
    row.normal = first;
    row.source = index;
    row.slot = k;
    problem.rows.push_back(row);
  }
}

int unknown_of(const Problem& problem, int body) {
  const auto found = std::ranges::lower_bound(problem.bodies, body);
  const bool present = found != problem.bodies.end() && *found == body;
  return present ? static_cast<int>(found - problem.bodies.begin()) : -1;
}

Vec6 joined(const Vec3& a, const Vec3& b) {
  return {a.x, a.y, a.z, b.x, b.y, b.z};
}

void normalise_row(const System& system, const Problem& p, Row& row) {
  const auto side = [&](int unknown, const Vec3& linear, const Vec3& angular) {
    if (unknown < 0) return Vec6{};
    const double inverse = 1 / std::sqrt(system.bodies[p.bodies[unknown]].mass);
    return joined(inverse * linear, p.inverse_root[unknown] * angular);
  };
  row.ja = side(row.a, -row.linear, row.angular_a);
  row.jb = side(row.b, row.linear, row.angular_b);
  row.weight = row.step = dot(row.ja, row.ja) + dot(row.jb, row.jb);
}

void set_tangent_steps(Row& u, Row& w) {
  const double cross_weight = dot(u.ja, w.ja) + dot(u.jb, w.jb);
  const double mean = (u.weight + w.weight) / 2, half = (u.weight - w.weight) / 2;
  u.step = w.step = mean + std::hypot(half, cross_weight);
}

void append_joints(const System& system, double h, Problem& problem) {
  const std::size_t first = problem.rows.size();
  for (const int joint : problem.joints)
    append_joint_rows(system, joint, h, problem.rows);
  for (std::size_t i = first; i < problem.rows.size(); ++i) {
    problem.rows[i].a = unknown_of(problem, problem.rows[i].a);
    problem.rows[i].b = unknown_of(problem, problem.rows[i].b);
  }
}

}  // namespace

void append_joint_rows(const System& system, int joint, double h, std::vector<Row>& rows) {
  JointRows(system, joint, h, rows).append();
}

std::vector<Problem> make_islands(const System& system) {
  const int count = static_cast<int>(system.bodies.size());
  Unions unions(count);
  const auto join = [&](int a, int b) {
    if (!system.bodies[a].fixed() && !system.bodies[b].fixed()) unions.join(a, b);
  };
  for (const Contact& c : system.contacts)
    join(c.a, c.b);
  for (const Joint& j : system.joints)
    join(j.a, j.b);
  std::vector<int> island_of(count, -1);
  std::vector<Problem> islands;
  for (int body = 0; body < count; ++body) {
    if (system.bodies[body].fixed()) continue;
    int& island = island_of[unions.find(body)];
    if (island < 0) {
      island = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    islands[island].bodies.push_back(body);
  }
  const auto owner = [&](int a, int b) -> Problem& {
    return islands[island_of[unions.find(system.bodies[a].fixed() ? b : a)]];
  };
  for (int i = 0; i < static_cast<int>(system.contacts.size()); ++i)
    append_contact_rows(system, i, owner(system.contacts[i].a, system.contacts[i].b));
  for (int i = 0; i < static_cast<int>(system.joints.size()); ++i)
    owner(system.joints[i].a, system.joints[i].b).joints.push_back(i);
  return islands;
}

void make_rows(const System& system, double h, Problem& problem) {
  problem.contact_rows = static_cast<int>(problem.rows.size());
  for (Row& row : problem.rows) {
    row.a = unknown_of(problem, row.a);
    row.b = unknown_of(problem, row.b);
  }
  problem.stiffening.assign(problem.bodies.size(), {});
  append_joints(system, h, problem);
  normalise(system, problem);
}

void refresh(const System& system, double h, Problem& problem) {
  std::vector<Row> old(problem.rows.begin() + problem.contact_rows, problem.rows.end());
  problem.rows.resize(problem.contact_rows);
  append_joints(system, h, problem);
  for (std::size_t i = 0; i < old.size(); ++i) {
    Row& row = problem.rows[problem.contact_rows + i];
    row.impulse = old[i].impulse;
    row.centre = old[i].centre;
  }
  normalise(system, problem);
}

void normalise(const System& system, Problem& problem) {
  problem.root.clear();
  problem.inverse_root.clear();
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    Mat3 inertia = system.bodies[problem.bodies[i]].inertia;
    inertia.x.x += problem.stiffening[i].x;
    inertia.y.y += problem.stiffening[i].y;
    inertia.z.z += problem.stiffening[i].z;
    problem.root.push_back(cholesky(inertia));
    problem.inverse_root.push_back(inverse(problem.root.back()));
  }
  normalise_rows(system, problem);
}

void normalise_rows(const System& system, Problem& problem) {
  for (Row& row : problem.rows)
    normalise_row(system, problem, row);
  for (int i = 0; i < problem.contact_rows; i += 3)
    set_tangent_steps(problem.rows[i + 1], problem.rows[i + 2]);
}

void set_drive(Row& row, const Joint& joint, double h) {
  if (row.kind == RowKind::motor) row.bias = -row.target;
  if (row.kind != RowKind::spring) return;
  const double rate = joint.spring_rate, sum = 2 * joint.spring_damping + h * rate;
  row.give = row.weight / (h * rate * sum);
  row.bias = row.error * rate / sum;
}

void project_on_cone(Problem& problem, std::size_t row) {
  Row &u = problem.rows[row], &w = problem.rows[row + 1];
  const double most = u.friction * problem.rows[u.normal].impulse;
  const double size = std::hypot(u.impulse, w.impulse);
  if (size <= most) return;
  u.impulse *= most / size;
  w.impulse *= most / size;
}

void gather(const System& system, Problem& problem) {
  problem.velocity.resize(problem.bodies.size());
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const Body& body = system.bodies[problem.bodies[i]];
    problem.velocity[i] =
        joined(std::sqrt(body.mass) * body.velocity, transposed(problem.root[i]) * body.spin);
  }
}

void scatter(System& system, const Problem& problem) {
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    Body& body = system.bodies[problem.bodies[i]];
    const Vec6& u = problem.velocity[i];
    body.velocity = (1 / std::sqrt(body.mass)) * Vec3{u[0], u[1], u[2]};
    body.spin = transposed(problem.inverse_root[i]) * Vec3{u[3], u[4], u[5]};
  }
}

void store_impulses(System& system, const Problem& problem) {
  for (const Row& row : problem.rows) {
    if (row.kind == RowKind::normal || row.kind == RowKind::tangent)
      system.contacts[row.source].impulse[row.slot] = row.impulse;
    else
      system.joints[row.source].impulse[row.slot] = row.impulse;
  }
}

}  // namespace lockstone::bench::trial
