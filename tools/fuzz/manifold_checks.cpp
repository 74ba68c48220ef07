#include <numbers>

#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/distance/cores/rims.h"
#include "tools/fuzz/pair_checks.h"
#include "tools/fuzz/surface.h"

namespace lockstone::fuzz {
namespace {

// Separations saturate at ±128 m.
constexpr double k_deepest = -127;

// A face stands where an edge overlaps less by a tenth and 0.49 mm, and of two shapes' faces the
// first stands where the second overlaps less by 1/32 and 0.25 mm (preference.h). Both may apply at
// once: an edge by itself less deep than the second face yields to the first.
double preferred(double depth) {
  constexpr double k_millimetre = 1e-3;
  const double face = (depth + 0.49 * k_millimetre) / 0.9;
  return (face + 0.25 * k_millimetre) * 32 / 31 - depth;
}

void check_apart(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const double truth = real(answers.closest.distance);
  const double slack = choice_slack(pair, truth);
  const double error = answers.least() - truth;
  if (!leans_back(pair, real(answers.closest.normal)))
    verdict.measure(Check::apart, error, slack);
  else if (truth > slack)
    verdict.measure(Check::apart, std::min(0.0, error), slack);
}

// Whether the front of a one-sided shape may push beside the shortest way out: that leans back, or
// the other's centre is in the plane, and a way mirrored by it is as short.
bool may_push_aside(const Pair& pair, const Real3& out) {
  return leans_back(pair, out) || height_before_front(pair) < tolerance(pair);
}

// Shapes that touch a triangle within the rounding may be before it or behind.
bool may_be_behind(const Pair& pair, double distance) {
  return pair.has(Kind::triangle) && std::abs(distance) < tolerance(pair);
}

// Nearly parallel edges are as near along many directions. So near a rim, one that leans back may
// be taken for the nearest.
bool may_lean_back(const Pair& pair, const Vec3<Unit>& out, double distance) {
  constexpr double k_near = 16 * k_micrometre;
  const bool is_near_rim =
      pair.has(Kind::triangle) && pair.has_rims() && std::abs(distance) < k_near;
  return is_near_rim || leans_back(pair, real(out));
}

// Points may be less deep than the shapes along the normal, where those beside the face are cut
// off.
void check_deep(const Pair& pair, const Answers& answers, Verdict& verdict) {
  if (may_push_aside(pair, real(answers.deep.normal))) return;
  const double depth = real(answers.deep.depth);
  const double excess = std::min(-answers.least(), -k_deepest) - depth;
  verdict.measure(Check::overlap, std::max(0.0, excess), choice_slack(pair, 0) + preferred(depth));
  if (depth > choice_slack(pair, 0)) verdict.require(Check::overlap, answers.least() <= 0);
}

// The deepest point of a core inside something with faces is not on the surfaces.
bool has_core_inside(const Pair& pair, double separation) {
  const bool cored = pair.has(Kind::capsule) || pair.has(Kind::tapered_capsule) ||
                     pair.has(Kind::rounded_box) || pair.has(Kind::rounded_hull);
  if (!cored || pair.half_space() != nullptr) return false;
  const bool faces = pair.has(Kind::box) || pair.has(Kind::hull) || pair.has(Kind::triangle) ||
                     pair.has_rims() || pair.has(Kind::rounded_box) || pair.has(Kind::rounded_hull);
  return faces && separation < 2 * tolerance(pair) - pair.radii();
}

// The least radius of round shapes.
double least_radius(const Pair& pair) {
  double least = 1e30;
  for (const double radius :
       {pair.a.radius, pair.b.radius, pair.a.rim_radius(), pair.b.rim_radius()})
    if (radius > 0) least = std::min(least, radius);
  return least;
}

// How far points of a shape with rims are aside. The normal of a single point is uncertain by half
// a step of a rim, a polygon of 2^15 sides, and the points lie along it over the depth. Two lines
// that run side by side are by up to 1/64 of the least radius aside (`widest_aside`), of which each
// surface has a half, and a surface of radius r curves away by r / 2^15 there. Faces are clipped in
// steps of 2^-27 of the sizes, and lines that cross at 1/32 err by 32 of these.
double aside_slack(const Pair& pair, const Manifold& m, double separation) {
  if (!pair.has_rims()) return 0;
  if (m.points[0].feature == geometry::k_single_point)
    return std::abs(separation) * std::numbers::pi / (1 << geometry::k_rim_bits);
  return std::ldexp(pair.size(), -22) + (m.count <= 2 ? std::ldexp(least_radius(pair), -15) : 0);
}

// The cosine of the least lean of the faces around the deepest vertex.
double shown_face(const Body& body, const Real3& normal) {
  const geometry::Polytope& p = *body.polytope;
  std::size_t deepest = 0;
  for (std::size_t i = 1; i < body.core.size(); ++i)
    if (dot(body.core[i], normal) > dot(body.core[deepest], normal)) deepest = i;
  double most = 0;
  for (const geometry::HalfEdge& edge : p.edges)
    if (edge.origin == deepest)
      most = std::max(most, dot(turn(body.rotation, real(p.faces[edge.face].normal)), normal));
  return most;
}

// Of the greater ball around the core of a capsule or a tapered one.
double ball_radius(const Body& body) {
  return body.is_tapered() ? body.radius + std::max(body.swell[0], body.swell[1]) : body.radius;
}

// The point of a ball around an end of the core is within the side, where the core leans.
double end_slack(const Body& body, const Real3& normal) {
  if (body.core.size() < 2) return 0;
  const Real3 core = body.core[1] - body.core[0];
  if (norm(core) == 0) return 0;
  const double lean = std::abs(dot(core, normal)) + std::abs(body.swell[1] - body.swell[0]);
  const double sine = std::min(lean / norm(core), 1.0);
  return ball_radius(body) * (1 - std::sqrt(1 - sine * sine));
}

// The points of a rounded face that leans are those of balls around its vertices, of which only the
// deepest is on the surface. So are the ends of an edge that leans by less than 1/32. A face is
// shown up to 30° from the nearest axis; of shapes that overlap, the normal may be another.
double lean_slack(const Body& body, const Real3& normal, double deepest) {
  if (body.kind == Kind::capsule || body.is_tapered()) return end_slack(body, normal);
  if (!body.is_rounded()) return 0;
  double most = body.polytope != nullptr ? shown_face(body, normal) : 0;
  for (int axis = 0; axis < 3 && body.polytope == nullptr; ++axis)
    most = std::max(most, std::abs(dot(direction_of(real(body.rotation.column(axis))), normal)));
  const bool shows_face = deepest < 0 || most > std::cos(std::numbers::pi / 6) - 1e-6;
  return 1.1 * body.radius * (1 - std::min(shows_face ? most : 1, std::cos(1.0 / 32)));
}

// A vertex may be moved onto a side by 31 µm, and at a corner onto two.
double surface_slack(const Pair& pair, const Manifold& m, double separation, double deepest) {
  const double snap = pair.radii() > 0 ? 0 : 32 * k_micrometre * std::numbers::sqrt2;
  const bool leans = pair.has(Kind::capsule) || pair.has(Kind::tapered_capsule);
  const double share = leans ? (ball_radius(pair.a) + ball_radius(pair.b)) / 1000 : 0;
  const Real3 n = direction_of(real(m.normal));
  const double rounded = lean_slack(pair.a, n, deepest) + lean_slack(pair.b, -n, deepest);
  return tolerance(pair) + snap + share + rounded + aside_slack(pair, m, separation) +
         uneven_slack(pair);
}

// How far the common anchor of overlapping shapes is from A's surface, as a share of the overlap.
double share_of_a(const Pair& pair) {
  const auto is_round = [](const Body& body) {
    return (body.radius > 0 && !body.is_rounded()) || body.has_rims();
  };
  const bool round_a = is_round(pair.a), round_b = is_round(pair.b);
  if (round_a == round_b) return 0.5;
  return round_a ? 0 : 1;
}

void check_point(const Pair& pair, const Manifold& m, const ManifoldPoint& p,
                 const Penetration& deep, Verdict& verdict) {
  const Real3 out = real(deep.normal);
  const double separation = real(p.separation);
  Real3 on_a = real(p.anchor_a), on_b = real(p.anchor_b);
  if (separation <= 0) {
    verdict.require(Check::manifold, p.anchor_b == p.anchor_a - pair.offset);
    const double share = share_of_a(pair);
    on_a = on_a - real(m.normal) * (separation * share);
    on_b = on_b + real(m.normal) * (separation * (1 - share));
  }
  const double deepest = std::min(separation, -real(deep.depth));
  const bool of_all = pair.has_rims() || pair.a.is_rounded() || pair.b.is_rounded();
  if (separation < k_deepest || has_core_inside(pair, of_all ? deepest : separation)) return;
  if (separation <= 0 && may_push_aside(pair, out)) return;
  // The point of a ball around an end of a rounded edge may be within the side.
  const auto check_surface = [&](const Body& body, const Real3& point) {
    const double beyond = outside(body, point);
    const double within = body.is_rounded() ? std::min(beyond + body.radius, 0.0) : beyond;
    verdict.measure(Check::anchors, beyond > 0 ? beyond : within,
                    surface_slack(pair, m, separation, deepest));
  };
  check_surface(pair.a, on_a);
  check_surface(pair.b, on_b);
}

}  // namespace

void check_collide(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const double truth = answers.signed_distance();
  const double margin = real(pair.margin);
  const double slack = choice_slack(pair, truth);
  const bool any = answers.manifold.count > 0;
  const double height = height_before_front(pair);
  if (truth > margin + slack || height < -tolerance(pair)) verdict.require(Check::margin, !any);
  const Vec3<Unit>& out = truth > 0 ? answers.closest.normal : answers.deep.normal;
  const bool unsure = may_be_behind(pair, truth);
  const bool is_met = height > tolerance(pair) && !unsure && !may_lean_back(pair, out, truth);
  if (truth < margin - slack && is_met) verdict.require(Check::margin, any);
  if (!any || unsure) return;
  if (truth > 0)
    check_apart(pair, answers, verdict);
  else
    check_deep(pair, answers, verdict);
}

void check_manifold(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const Manifold& m = answers.manifold;
  verdict.require(Check::manifold, m.count >= 0 && m.count <= k_max_manifold_points);
  if (m.count == 0) return;
  verdict.measure(Check::manifold, norm(real(m.normal)) - 1, std::ldexp(1.0, -29));
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    const Displacement s = m.points[i].separation;
    verdict.require(Check::manifold, s <= Displacement{} || real(s) < real(pair.margin));
    if (i > 0) verdict.require(Check::manifold, m.points[i - 1].feature < m.points[i].feature);
  }
}

void check_anchors(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const Manifold& m = answers.manifold;
  if (m.count == 0 || may_be_behind(pair, answers.signed_distance())) return;
  const double along = separation(pair, real(pair.offset), direction_of(real(m.normal)));
  if (along > k_deepest)
    verdict.measure(Check::anchors, std::max(0.0, along - answers.least()), tolerance(pair));
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    check_point(pair, m, m.points[i], answers.deep, verdict);
}

}  // namespace lockstone::fuzz
