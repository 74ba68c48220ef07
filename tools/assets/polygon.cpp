#include "tools/assets/polygon.h"

#include <numeric>

#include "core/math/int128.h"

namespace lockstone::assets {
namespace {

/// Seen from the front: raw coordinates.
struct Flat {
  std::int64_t u = 0;
  std::int64_t v = 0;

  friend bool operator==(const Flat&, const Flat&) = default;
};

using Ring = std::vector<std::uint32_t>;

/// Twice the signed area; within 2^61 for coordinates within 2^29.
std::int64_t turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// Twice the signed area of the polygon's shadow on the plane of the axes u and v.
Int128 doubled_area(Corners corners, int u, int v) {
  Int128 sum{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3<Length>& a = corners[i];
    const Vec3<Length>& b = corners[(i + 1) % corners.size()];
    sum = sum + multiply_wide(std::int64_t{a[u].raw}, std::int64_t{b[v].raw}) -
          multiply_wide(std::int64_t{a[v].raw}, std::int64_t{b[u].raw});
  }
  return sum;
}

/// The corners seen along the axis with the largest shadow, counter-clockwise; empty without area.
std::vector<Flat> flatten(Corners corners) {
  int u = 0, v = 0;
  Int128 area{};
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const Int128 shadow = doubled_area(corners, next, last);
    if (magnitude(shadow) <= magnitude(area)) continue;
    area = shadow;
    u = area.negative() ? last : next;
    v = area.negative() ? next : last;
  }
  std::vector<Flat> flat;
  if (u == v) return flat;
  for (const Vec3<Length>& corner : corners)
    flat.push_back({corner[u].raw, corner[v].raw});
  return flat;
}

/// Corner i of the ring with its neighbours.
CornerTriple triple_at(const Ring& ring, std::size_t i) {
  const std::size_t count = ring.size();
  return {ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]};
}

std::int64_t turn_at(const std::vector<Flat>& flat, const CornerTriple& t) {
  return turn(flat[t[0]], flat[t[1]], flat[t[2]]);
}

/// Whether no other corner lies in the closed triangle. One at the place of a corner does not
/// count.
bool is_clear(const std::vector<Flat>& flat, const Ring& ring, const CornerTriple& t) {
  const Flat &a = flat[t[0]], &b = flat[t[1]], &c = flat[t[2]];
  for (const std::uint32_t index : ring) {
    const Flat& p = flat[index];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

/// The first corner that can be cut off: an ear, else one that is no corner at all.
std::optional<std::size_t> find_ear(const std::vector<Flat>& flat, const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const CornerTriple t = triple_at(ring, i);
    if (turn_at(flat, t) > 0 && is_clear(flat, ring, t)) return i;
  }
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (turn_at(flat, triple_at(ring, i)) == 0) return i;
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<CornerTriple>> triangulate(Corners corners) {
  const std::vector<Flat> flat = flatten(corners);
  if (flat.empty()) return std::nullopt;
  std::vector<CornerTriple> triangles;
  Ring ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0U);
  while (ring.size() >= 3) {
    const std::optional<std::size_t> ear = find_ear(flat, ring);
    if (!ear) return std::nullopt;
    const CornerTriple t = triple_at(ring, *ear);
    if (turn_at(flat, t) > 0) triangles.push_back(t);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(*ear));
  }
  return triangles;
}

}  // namespace lockstone::assets
