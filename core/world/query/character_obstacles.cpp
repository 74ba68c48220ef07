#include "core/world/query/character_obstacles.h"

#include <algorithm>
#include <array>

#include "core/dynamics/state/one_way_bits.h"
#include "core/math/roots.h"
#include "core/math/rounded_dot.h"

namespace lockstone {
namespace {

// One-way bodies that a cast passes beside those that stop it.
constexpr std::size_t k_max_hits = 32;

}  // namespace

ShapeHit CharacterObstacles::cast(const Vec3<Position>& from, const Vec3<Length>& motion) const {
  const ShapeCast way{def_.shape, {from, def_.orientation}, motion};
  const ShapeHit first = world_.cast_shape(way, def_.filter);
  if (first.body.is_null() || stops(first)) return first;
  std::array<ShapeHit, k_max_hits> all;
  const auto hits = std::span(all).first(world_.cast_shape_all(way, all, def_.filter));
  const auto at = std::ranges::find_if(hits, [&](const ShapeHit& hit) { return stops(hit); });
  return at == hits.end() ? ShapeHit{} : *at;
}

std::size_t CharacterObstacles::contacts(const Vec3<Position>& position, Length margin,
                                         std::span<ShapeContact> out) const {
  const std::size_t count =
      world_.contacts_of_shape(def_.shape, {position, def_.orientation}, margin, out, def_.filter);
  const auto found = out.first(count);
  const auto end = std::remove_if(found.begin(), found.end(),
                                  [&](const ShapeContact& contact) { return !stops(contact); });
  return static_cast<std::size_t>(end - found.begin());
}

bool CharacterObstacles::is_in_front(BodyHandle body, const OneWay& rule,
                                     const Vec3<Unit>& normal) const {
  const Mat3 axes = to_matrix(pose_of(world_, body).orientation);
  return rounded<Unit>(dot(rotate(axes, rule.direction), normal)) >= least_cosine(rule);
}

// A cast that begins inside hits at 0.
bool CharacterObstacles::stops(const ShapeHit& hit) const {
  const OneWay rule = one_way_of(world_, hit.body);
  if (rule.direction == Vec3<Unit>{}) return true;
  return hit.fraction > Unit{} && is_in_front(hit.body, rule, hit.normal);
}

bool CharacterObstacles::stops(const ShapeContact& contact) const {
  const OneWay rule = one_way_of(world_, contact.body);
  if (rule.direction == Vec3<Unit>{}) return true;
  return is_in_front(contact.body, rule, contact.normal) &&
         -rounded<Length>(contact.separation) <= depth_allowed(contact.body, contact.normal);
}

// A lift comes up to its riders by its way in a tick.
Length CharacterObstacles::depth_allowed(BodyHandle body, const Vec3<Unit>& normal) const {
  const std::int64_t speed = rounded_dot(world_.velocity(body), normal);
  const std::int64_t way = raw::round_divide(speed, std::int64_t{world_.def().tick_rate});
  return def_.skin + max(saturated<Length>(Position::from_raw(way)), Length{});
}

}  // namespace lockstone
