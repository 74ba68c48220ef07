#include <array>

#include <fmt/format.h>

#include "core/geometry/numeric/q50.h"
#include "core/geometry/shapes/tapered_ends.h"
#include "tools/fuzz/pair_source.h"

namespace lockstone::fuzz {
namespace {

constexpr std::array<std::string_view, k_kinds> k_names{
    "sphere", "capsule",         "box",         "hull",        "triangle", "half-space", "cylinder",
    "cone",   "tapered-capsule", "rounded-box", "rounded-hull"};

std::vector<Real3> own_core(const Body& body) {
  if (body.polytope != nullptr) {
    std::vector<Real3> core;
    for (const Vec3<Length>& v : body.polytope->vertices)
      core.push_back(real(v));
    return core;
  }
  const Real3 size = real(body.shape.size);
  if (body.kind == Kind::cylinder) return {};
  if (body.kind == Kind::cone) return {{0, size.y * 3 / 4, 0}};
  if (body.is_tapered()) {
    const geometry::TaperedEnds ends = geometry::tapered_ends(body.shape.size);
    const auto at = [](geometry::Fine y) {
      return Real3{0, std::ldexp(static_cast<double>(y), -geometry::k_fine_bits), 0};
    };
    return {at(ends.low), at(ends.high)};
  }
  if (body.kind == Kind::capsule) return {{0, -size.y, 0}, {0, size.y, 0}};
  if (!body.is_box()) return {{}};
  std::vector<Real3> core;
  for (int i = 0; i < 8; ++i)
    core.push_back({(i & 1) != 0 ? size.x : -size.x, (i & 2) != 0 ? size.y : -size.y,
                    (i & 4) != 0 ? size.z : -size.z});
  return core;
}

std::vector<Circle> rims_of(const Body& body) {
  const Real3 size = real(body.shape.size), axis = direction_of(real(body.rotation.y));
  const auto at = [&](double height) {
    return Circle{turn(body.rotation, {0, height, 0}), axis, size.x};
  };
  if (body.kind == Kind::cylinder) return {at(-size.y), at(size.y)};
  if (body.kind == Kind::cone) return {at(-size.y / 4)};
  return {};
}

double reach_of(const Circle& rim, const Real3& direction) {
  const Real3 aside = direction - rim.axis * dot(direction, rim.axis);
  return dot(rim.centre, direction) + rim.radius * norm(aside);
}

std::string text_of(const Vec3<Length>& v) {
  return fmt::format("({}, {}, {})", v.x.raw, v.y.raw, v.z.raw);
}

std::string text_of(const Body& body) {
  std::string text =
      fmt::format("{} size {} rotation", k_names[static_cast<std::size_t>(body.kind)],
                  text_of(body.shape.size));
  if (body.is_rounded()) text = fmt::format("radius {} ", body.radius) + text;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<Unit>& c = body.rotation.column(axis);
    text += fmt::format(" ({}, {}, {})", c.x.raw, c.y.raw, c.z.raw);
  }
  if (body.polytope == nullptr) return text;
  text += fmt::format(" {} faces, uneven by {:.3g} m, vertices", body.polytope->faces.size(),
                      body.unevenness);
  for (const Vec3<Length>& v : body.polytope->vertices)
    text += fmt::format(" {}", text_of(v));
  return text;
}

}  // namespace

std::string_view name_of(Kind kind) {
  return k_names[static_cast<std::size_t>(kind)];
}

std::optional<Kind> kind_named(std::string_view name) {
  const auto found = std::find(k_names.begin(), k_names.end(), name);
  if (found == k_names.end()) return std::nullopt;
  return static_cast<Kind>(found - k_names.begin());
}

bool do_meet(Kind a, Kind b) {
  const auto is_solid = [](Kind kind) {
    return kind != Kind::triangle && kind != Kind::half_space;
  };
  return is_solid(a) || is_solid(b);
}

void Body::turn_to(const Mat3& to) {
  rotation = to;
  core = own_core(*this);
  for (Real3& p : core)
    p = turn(rotation, p);
  rims = rims_of(*this);
}

double Body::reach(const Real3& direction) const {
  double most = -1e30;
  for (std::size_t i = 0; i < core.size(); ++i)
    most = std::max(most, dot(core[i], direction) + (is_tapered() ? swell[i] : 0));
  for (const Circle& rim : rims)
    most = std::max(most, reach_of(rim, direction));
  return most + radius;
}

double Body::size() const {
  double most = 0;
  for (std::size_t i = 0; i < core.size(); ++i)
    most = std::max(most, norm(core[i]) + (is_tapered() ? swell[i] : 0));
  for (const Circle& rim : rims)
    most = std::max(most, std::hypot(norm(rim.centre), rim.radius));
  return most + radius;
}

const Body* Pair::half_space() const {
  if (a.kind == Kind::half_space) return &a;
  return b.kind == Kind::half_space ? &b : nullptr;
}

double Pair::size() const {
  return std::max(a.size(), b.size() + norm(real(offset)));
}

double separation(const Pair& pair, const Real3& offset, const Real3& direction) {
  return dot(offset, direction) - pair.b.reach(-direction) - pair.a.reach(direction);
}

std::string describe(const Pair& pair) {
  return fmt::format("A {}\nB {}\noffset {} margin {}\ncast from {} by {}\nray from {} by {}\n",
                     text_of(pair.a), text_of(pair.b), text_of(pair.offset), pair.margin.raw,
                     text_of(pair.cast_from), text_of(pair.way), text_of(pair.ray_origin),
                     text_of(pair.ray_way));
}

}  // namespace lockstone::fuzz
