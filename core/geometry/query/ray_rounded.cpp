#include "core/geometry/query/ray_rounded.h"

#include <lockstone/assert.h>

#include "core/geometry/contact/polytope/polytope_point.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/query/ray_round.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_share_bits = 60;

/// No ray slips between two parts of the surface: 2 µm.
constexpr Fine k_rounded_seam = Fine{1} << (k_fine_bits - 19);

/// The earliest meeting so far. A ray that starts outside enters the solid there.
class RoundedEntry {
 public:
  RoundedEntry(const Polytope& polytope, const RawVec& start, const RawVec& way)
      : polytope_(polytope), start_(start), way_(way), radius_(fine(polytope.radius)) {}

  void meet_face(const PolytopeFace& face, int index) {
    const Fine height = height_above(face, split(start_)) - radius_;
    const Fine rise = dot(split(way_), face.normal);
    if (height < 0 || rise >= 0 || height > -rise) return;
    const auto share = static_cast<std::int64_t>(
        round_divide(UInt128{0, static_cast<std::uint64_t>(height)} << k_share_bits,
                     static_cast<std::uint64_t>(-rise)));
    if (!is_beside(polytope_, index, point_at_share(share))) return;
    take(share, raws_of(face.normal));
  }

  void meet_edge(int edge) {
    const RawVec from = start_ - fine(start_of(polytope_, edge));
    const Vec3<Length> whole = edge_vector(polytope_, edge);
    const Direction way = direction(fine(whole).x, fine(whole).y, fine(whole).z);
    const auto across = [&](const RawVec& v) { return v - along(way.unit, dot(v, way.unit)); };
    const RawVec flat = across(from), flat_way = across(way_);
    const RoundHit at = first_meeting(flat, flat_way, radius_);
    if (!at.hit) return;
    const Fine place = dot(from, way.unit) + part(dot(way_, way.unit), at.fraction);
    if (place < -k_rounded_seam || place > static_cast<Fine>(way.length) + k_rounded_seam) return;
    take(at.fraction, flat + part(flat_way, at.fraction));
  }

  void meet_vertex(const Vec3<Length>& vertex) {
    const RawVec from = start_ - fine(vertex);
    const RoundHit at = first_meeting(from, way_, radius_);
    if (at.hit) take(at.fraction, from + part(way_, at.fraction));
  }

  [[nodiscard]] ShapeRayHit hit(const Mat3& rotation) const {
    if (!found_) return {};
    const std::int64_t fraction = raw::round_shift(share_, k_share_bits - Unit::frac_bits);
    const Vec3<Unit> local = direction_of(outward_.x, outward_.y, outward_.z);
    return {true, Unit::from_raw(static_cast<std::int32_t>(fraction)),
            unit_axis(lockstone::rotate(rotation, local))};
  }

 private:
  static Fine part(Fine lane, std::int64_t share) {
    return saturated_product(lane, share, k_share_bits);
  }
  static RawVec part(const RawVec& v, std::int64_t share) {
    return {part(v.x, share), part(v.y, share), part(v.z, share)};
  }
  [[nodiscard]] RawVec point_at_share(std::int64_t share) const {
    return start_ + part(way_, share);
  }

  void take(std::int64_t share, const RawVec& outward) {
    if (found_ && share >= share_) return;
    found_ = true;
    share_ = share;
    outward_ = outward;
  }

  const Polytope& polytope_;
  const RawVec& start_;
  const RawVec& way_;
  Fine radius_;
  bool found_ = false;
  std::int64_t share_ = 0;
  RawVec outward_{};
};

}  // namespace

ShapeRayHit cast_ray_at_rounded(const Polytope& polytope, const Mat3& rotation,
                                const Vec3<Length>& origin, const Vec3<Length>& translation) {
  LKS_ASSERT(polytope.radius > Length{} && !is_flat(polytope));
  const RawVec start = to_local(rotation, origin), way = to_local(rotation, translation);
  if (nearest_point(polytope, start, fine(polytope.radius)).found) return {true, {}, {}};
  RoundedEntry entry(polytope, start, way);
  for (std::size_t i = 0; i < polytope.faces.size(); ++i)
    entry.meet_face(polytope.faces[i], static_cast<int>(i));
  const int edges = static_cast<int>(polytope.edges.size());
  for (int edge = 0; edge < edges; ++edge)
    if (is_first_half(polytope, edge)) entry.meet_edge(edge);
  for (const Vec3<Length>& vertex : polytope.vertices)
    entry.meet_vertex(vertex);
  return entry.hit(rotation);
}

}  // namespace lockstone::geometry
