// The constraint rows of one island, divided by the square root of the mass matrix: in these
// coordinates every body has mass and inertia one.
#pragma once

#include <vector>

#include "tools/bench/baselines/solvers/block_factor.h"
#include "tools/bench/baselines/solvers/options.h"
#include "tools/bench/baselines/solvers/system.h"

namespace lockstone::bench::trial {

enum class RowKind { normal, tangent, limit, bilateral, motor, spring };

// J v + bias → 0. A fixed body has the index −1.
struct Row {
  RowKind kind = RowKind::bilateral;
  int a = -1, b = -1;  // unknowns of the problem
  Vec3 linear, angular_a, angular_b;
  Vec6 ja{}, jb{};
  double weight = 0;  // J M⁻¹ Jᵀ
  double step = 0;    // tangents: the greatest eigenvalue of both; else the weight
  double error = 0;   // position error; m or rad
  double bias = 0;
  double give = 0;  // compliance γ
  double centre = 0;
  double impulse = 0;
  double limit = 1e300;  // motors: greatest impulse
  double friction = 0;
  double target = 0;   // motors: speed
  int normal = -1;     // tangents: their normal row
  int source = 0;      // contact or joint
  int slot = 0;        // of the source's impulses
  int rotational = 0;  // 1: error in radians
  bool active = false;
};

struct Problem {
  std::vector<int> bodies;  // of the system
  std::vector<Vec6> velocity;
  std::vector<Mat3> root;  // inertia = root rootᵀ, lower triangle
  std::vector<Mat3> inverse_root;
  std::vector<Vec3> stiffening;  // geometric stiffness, added to the inertia's diagonal
  std::vector<Row> rows;         // contacts first
  std::vector<int> joints;
  int contact_rows = 0;
};

// Body → unknown of its island; islands of bodies that contacts or joints connect, by least body.
std::vector<Problem> make_islands(const System& system);

// Rows of a joint at its bodies' present poses.
void append_joint_rows(const System& system, int joint, double h, std::vector<Row>& rows);

void make_rows(const System& system, double h, Problem& problem);
// Masses and all rows' coefficients at the present inertias; joints' rows again.
void refresh(const System& system, double h, Problem& problem);
void normalise(const System& system, Problem& problem);
// The rows alone, by the roots at hand.
void normalise_rows(const System& system, Problem& problem);
void gather(const System& system, Problem& problem);
void scatter(System& system, const Problem& problem);
// Springs and motors: bias and compliance, the same in every method.
void set_drive(Row& row, const Joint& joint, double h);
// Brings both tangent impulses, of which `row` is the first, within the friction cone.
void project_on_cone(Problem& problem, std::size_t row);
void store_impulses(System& system, const Problem& problem);

inline double speed(const Problem& p, const Row& r) {
  return (r.a >= 0 ? dot(r.ja, p.velocity[r.a]) : 0) + (r.b >= 0 ? dot(r.jb, p.velocity[r.b]) : 0);
}
inline void apply(Problem& p, const Row& r, double impulse) {
  if (r.a >= 0) add(p.velocity[r.a], r.ja, impulse);
  if (r.b >= 0) add(p.velocity[r.b], r.jb, impulse);
}

}  // namespace lockstone::bench::trial
