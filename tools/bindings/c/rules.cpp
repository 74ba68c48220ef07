// Rules about pairs.
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

PairSurface pair_surface_of(const lks_pair_surface& raw) {
  return {Coefficient::from_raw(raw.friction), Coefficient::from_raw(raw.restitution),
          Coefficient::from_raw(raw.rolling_resistance)};
}

std::optional<PairSurface> pair_surface_of(const lks_pair_surface* raw) {
  if (raw == nullptr) return {};
  return pair_surface_of(*raw);
}

lks_pair_surface raw_of(const std::optional<PairSurface>& surface) {
  const PairSurface known = surface.value_or(PairSurface{});
  return {known.friction.raw, known.restitution.raw, known.rolling_resistance.raw};
}

}  // namespace

lks_status lks_set_pair_rule(lks_world* world, lks_body a, lks_body b, uint32_t collides,
                             const lks_pair_surface* surface) {
  return call([&] {
    order(world, SetPairRule{handle_of<BodyHandle>(a),
                             handle_of<BodyHandle>(b),
                             {flag(collides, "collides"), pair_surface_of(surface)}});
  });
}

lks_status lks_pair_rule_get(const lks_world* world, lks_body a, lks_body b, uint32_t* collides,
                             uint32_t* has_surface, lks_pair_surface* surface) {
  return call([&] {
    const World& from = read(world);
    const PairRule rule = pair_rule_of(from, existing_body(from, a), existing_body(from, b));
    required(collides, "collides") = rule.collides ? 1 : 0;
    required(has_surface, "has_surface") = rule.surface ? 1 : 0;
    required(surface, "surface") = raw_of(rule.surface);
  });
}

lks_status lks_set_surface_rule(lks_world* world, uint32_t tag_a, uint32_t tag_b,
                                const lks_pair_surface* surface) {
  return call([&] { order(world, SetSurfaceRule{tag_a, tag_b, pair_surface_of(surface)}); });
}

lks_status lks_surface_rule_get(const lks_world* world, uint32_t tag_a, uint32_t tag_b,
                                uint32_t* has_surface, lks_pair_surface* surface) {
  return call([&] {
    const std::optional<PairSurface> rule = surface_rule_of(read(world), tag_a, tag_b);
    required(has_surface, "has_surface") = rule ? 1 : 0;
    required(surface, "surface") = raw_of(rule);
  });
}

lks_status lks_set_one_way(lks_world* world, lks_body body, const lks_unit3* direction,
                           uint32_t tolerance) {
  return call([&] {
    const auto degrees = static_cast<std::uint8_t>(tolerance < 256 ? tolerance : 255);
    order(world, SetOneWay{handle_of<BodyHandle>(body),
                           {vec<Unit>(required(direction, "direction")), degrees}});
  });
}

lks_status lks_one_way_get(const lks_world* world, lks_body body, lks_unit3* direction,
                           uint32_t* tolerance) {
  return call([&] {
    const World& from = read(world);
    const OneWay rule = one_way_of(from, existing_body(from, body));
    required(direction, "direction") = c::raw_of(rule.direction);
    required(tolerance, "tolerance") = rule.tolerance;
  });
}
