#include "tools/fuzz/pair_checks.h"

#include <array>

#include "core/geometry/dispatch/collide.h"
#include "core/geometry/distance/separation.h"
#include "tools/fuzz/least_overlap.h"
#include "tools/fuzz/surface.h"

namespace lockstone::fuzz {
namespace {

constexpr double k_face_slack = 16 * k_micrometre;
constexpr double k_capsule_share = 1.0 / 2000;

bool is_flipped(const Manifold& m, const Manifold& f, int steps) {
  if (m.count != f.count || (m.count > 0 && m.normal != -f.normal)) return false;
  const auto near = [&](const Vec3<Length>& a, const Vec3<Length>& b) {
    const Vec3<Length> shift = a - b;
    return abs(shift.x).raw <= steps && abs(shift.y).raw <= steps && abs(shift.z).raw <= steps;
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    const ManifoldPoint &p = m.points[i], &q = f.points[i];
    if (!near(p.anchor_a, q.anchor_b) || !near(p.anchor_b, q.anchor_a)) return false;
    if (p.separation != q.separation || p.feature != q.feature) return false;
  }
  return true;
}

bool is_flipped(const ClosestPoints& m, const ClosestPoints& f) {
  return m.overlapping == f.overlapping && m.cores_overlap == f.cores_overlap &&
         m.distance == f.distance && m.normal == -f.normal && m.point_a == f.point_b &&
         m.point_b == f.point_a && m.feature.a == f.feature.b && m.feature.b == f.feature.a;
}

bool is_flipped(const Penetration& m, const Penetration& f) {
  return m.overlapping == f.overlapping && m.depth == f.depth && m.normal == -f.normal &&
         m.point_a == f.point_b && m.point_b == f.point_a && m.exact == f.exact;
}

// Equal shapes in one place have no order: left out.
bool have_no_order(const Pair& pair) {
  return pair.offset == Vec3<Length>{} && pair.a.shape == pair.b.shape &&
         pair.a.rotation == pair.b.rotation && pair.a.kind != Kind::triangle;
}

Real3 corner(const Body& body, const ClosestFeature& feature, bool of_a, int i) {
  const auto k = static_cast<std::size_t>(std::min(i, feature.count - 1));
  return body.core[static_cast<std::size_t>(of_a ? feature.a[k] : feature.b[k])];
}

// How far a witness is from the surface that its feature says it is on.
double off_feature(const Body& body, const ClosestFeature& f, bool of_a, const Real3& on_core) {
  if (body.has_rims()) return outside(body, on_core);
  if (body.is_tapered()) return outside(body, on_core) + body.radius;
  return point_to_triangle(on_core, corner(body, f, of_a, 0), corner(body, f, of_a, 1),
                           corner(body, f, of_a, 2));
}

// A half-space's reference is in closed form.
double height_of_the_other(const Pair& pair) {
  const bool first = pair.a.kind == Kind::half_space;
  const Real3 up = direction_of(real((first ? pair.a : pair.b).rotation.y));
  return separation(pair, real(pair.offset), first ? up : -up);
}

}  // namespace

Answers::Answers(const Pair& pair)
    : closest(distance(pair.a.posed(), pair.b.posed(), pair.offset)),
      deep(penetration(pair.a.posed(), pair.b.posed(), pair.offset)),
      manifold(collide(pair.a.posed(), pair.b.posed(), pair.offset, pair.margin)) {}

double Answers::signed_distance() const {
  return closest.overlapping ? -real(deep.depth) : real(closest.distance);
}

double Answers::least() const {
  double least = 1e30;
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
    least = std::min(least, real(manifold.points[i].separation));
  return least;
}

double rim_slack(const Pair& pair) {
  return 6e-9 * pair.rim_radii();
}

double tolerance(const Pair& pair) {
  return 2 * k_micrometre + 13e-9 * pair.size() + rim_slack(pair);
}

double uneven_slack(const Pair& pair) {
  return 16 * (pair.a.unevenness + pair.b.unevenness);
}

double choice_slack(const Pair& pair, double distance) {
  const double rim =
      pair.has(Kind::capsule) ? (std::max(0.0, distance) + pair.radii()) * k_capsule_share : 0;
  // The points of a disc that stand still: see `add_disc`.
  const double disc = pair.has_rims() ? 3.4 * k_micrometre : 0;
  return tolerance(pair) + k_face_slack + rim + disc + uneven_slack(pair);
}

double height_before_front(const Pair& pair) {
  if (!pair.has(Kind::triangle)) return 1e30;
  const bool first = pair.a.is_one_sided();
  const Body &flat = first ? pair.a : pair.b, &other = first ? pair.b : pair.a;
  const Real3 offset = first ? real(pair.offset) : -real(pair.offset);
  const Real3 interior = other.polytope != nullptr ? real(other.polytope->interior) : Real3{};
  const Real3 normal = turn(flat.rotation, real(flat.polytope->faces[0].normal));
  return dot(offset + turn(other.rotation, interior) - flat.core[0], normal);
}

bool leans_back(const Pair& pair, const Real3& direction) {
  if (!pair.has(Kind::triangle)) return false;
  const bool first = pair.a.is_one_sided();
  const Body& flat = first ? pair.a : pair.b;
  const Real3 normal = turn(flat.rotation, real(flat.polytope->faces[0].normal));
  constexpr double k_lean = 2e-3;  // 2^-10 is met, and a little more where features are crumbs
  return dot(direction, normal) * (first ? 1 : -1) < k_lean;
}

void check_flip(const Pair& pair, const Answers& answers, Verdict& verdict) {
  if (have_no_order(pair)) return;
  const PosedShape a = pair.a.posed(), b = pair.b.posed();
  const bool spheres = pair.a.kind == Kind::sphere && pair.b.kind == Kind::sphere;
  verdict.require(
      Check::flip,
      is_flipped(answers.manifold, collide(b, a, -pair.offset, pair.margin), spheres ? 1 : 0));
  verdict.require(Check::flip, is_flipped(answers.closest, distance(b, a, -pair.offset)));
  verdict.require(Check::flip, is_flipped(answers.deep, penetration(b, a, -pair.offset)));
}

void check_distance(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const ClosestPoints& found = answers.closest;
  const double allowed = 2 * k_micrometre + rim_slack(pair);
  const double said = real(found.distance);
  verdict.require(Check::distance, found.overlapping == answers.deep.overlapping);
  if (pair.half_space() != nullptr) {
    verdict.measure(Check::distance, answers.signed_distance() - height_of_the_other(pair),
                    allowed);
    return;
  }
  if (found.overlapping) return;
  const Real3 n = direction_of(real(found.normal));
  verdict.measure(Check::distance, separation(pair, real(pair.offset), n) - said, allowed);
  const Real3 on_a = real(found.point_a), on_b = real(found.point_b);
  verdict.measure(Check::witness, norm(on_b + real(pair.offset) - on_a) - said, 2 * allowed);
  verdict.measure(Check::witness,
                  off_feature(pair.a, found.feature, true, on_a - n * pair.a.radius), allowed);
  verdict.measure(Check::witness,
                  off_feature(pair.b, found.feature, false, on_b + n * pair.b.radius), allowed);
}

void check_depth(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const Penetration& found = answers.deep;
  if (!found.overlapping || pair.half_space() != nullptr) return;
  const double allowed = tolerance(pair);
  const double depth = real(found.depth);
  const Real3 offset = real(pair.offset);
  const Real3 n = direction_of(real(found.normal));
  verdict.require(Check::depth, found.exact || pair.has_rims());
  verdict.measure(Check::depth, depth + separation(pair, offset, n), allowed);
  const Real3 gap = real(found.point_b) + offset - real(found.point_a);
  // Aside too: the points are those of exact features, within 8 steps of the foot on their plane.
  verdict.measure(Check::witness, norm(gap + n * depth), 2 * allowed);
  const std::array<Real3, 3> seeds{n, real(answers.manifold.normal), offset};
  verdict.measure(Check::depth, std::max(0.0, depth - least_overlap(pair, seeds)), allowed);
}

void check_turned(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const Mat3 a = multiply(pair.turn, pair.a.rotation), b = multiply(pair.turn, pair.b.rotation);
  const PosedShape posed_a{pair.a.shape, a, pair.a.polytope};
  const PosedShape posed_b{pair.b.shape, b, pair.b.polytope};
  const Vec3<Length> offset = rotate(pair.turn, pair.offset);
  const ClosestPoints closest = distance(posed_a, posed_b, offset);
  const Penetration deep = penetration(posed_a, posed_b, offset);
  const double turned = closest.overlapping ? -real(deep.depth) : real(closest.distance);
  verdict.measure(Check::turned, turned - answers.signed_distance(), 2 * tolerance(pair));
}

void check_separated(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const PosedShape a = pair.a.posed(), b = pair.b.posed();
  const Real3 offset = real(pair.offset);
  for (const Vec3<Unit>& axis :
       {answers.manifold.normal, answers.closest.normal, answers.deep.normal,
        to_unit(direction_of(offset)), pair.a.rotation.y, pair.turn.x}) {
    if (axis == Vec3<Unit>{}) continue;
    const bool separated = separated_along(a, b, pair.offset, pair.margin, axis);
    verdict.require(Check::separated,
                    separated == separated_along(b, a, -pair.offset, pair.margin, -axis));
    verdict.require(Check::separated, !separated || answers.manifold.count == 0);
  }
}

void check_overlaps(const Pair& pair, const Answers& answers, Verdict& verdict) {
  const PosedShape a = pair.a.posed(), b = pair.b.posed();
  const bool found = overlaps(a, b, pair.offset);
  verdict.require(Check::overlaps, found == (collide(a, b, pair.offset, {}).count > 0));
  const double truth = answers.signed_distance();
  const double unsure = tolerance(pair) + 4 * k_micrometre + pair.a.unevenness + pair.b.unevenness;
  if (truth > unsure) verdict.require(Check::overlaps, !found);
  const bool in_front = height_before_front(pair) > tolerance(pair);
  const bool is_met = in_front && !leans_back(pair, real(answers.deep.normal));
  if (truth < -unsure && is_met) verdict.require(Check::overlaps, found);
}

void check_pair(const Pair& pair, Verdict& verdict) {
  const Answers answers(pair);
  check_flip(pair, answers, verdict);
  check_distance(pair, answers, verdict);
  check_depth(pair, answers, verdict);
  check_turned(pair, answers, verdict);
  check_collide(pair, answers, verdict);
  check_manifold(pair, answers, verdict);
  check_anchors(pair, answers, verdict);
  check_separated(pair, answers, verdict);
  check_overlaps(pair, answers, verdict);
  check_cast(pair, verdict);
  check_ray(pair, verdict);
}

}  // namespace lockstone::fuzz
