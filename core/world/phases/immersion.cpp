#include "core/world/phases/immersion.h"

#include <algorithm>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/submerged/submerged.h"
#include "core/math/block_float.h"

namespace lockstone {
namespace {

using geometry::ConvexSolid;
using geometry::k_submerged_bits;
using geometry::SubmergedPart;

// Bodies are at most so many times lighter than the fluid that they displace.
constexpr std::int64_t k_most_share = std::int64_t{1} << 48;

class ImmersedPieces final : public PieceVisitor {
 public:
  ImmersedPieces(const BodyRecord& body, const PlacedShape& placed, const FluidRecord& fluid,
                 const Vec3<Unit>& along)
      : body_(body),
        centre_(placed.centre),
        fluid_(fluid),
        up_(to_matrix(fluid.orientation).y),
        along_(along) {}

  void visit(const Piece& piece) override {
    const ConvexSolid solid{piece.shape, piece.polytope};
    const SubmergedPart part = geometry::part_below(
        solid, {rotate_inverse(piece.rotation, up_), height_of_surface(piece.origin)});
    if (part.volume == 0) return;
    const std::int64_t share = over_mass(part.volume, 3 * part.scale);
    total_.share = std::min(total_.share + share, k_most_share);
    add_moment(piece, part, share);
    total_.per_metre =
        std::min(total_.per_metre + over_mass(part.plane_area, 2 * part.scale), k_most_share);
    if (along_ != Vec3<Unit>{}) add_shadow(piece, solid, part);
  }

  [[nodiscard]] const Immersion& total() const { return total_; }

 private:
  // Above a point, along the surface's normal.
  [[nodiscard]] Position height_of_surface(const Vec3<Position>& point) const {
    const Vec3<Position> way = fluid_.surface - point;
    Int128 sum{};
    for (int i = 0; i < 3; ++i)
      sum = sum + multiply_wide(way[i].raw, std::int64_t{up_[i].raw});
    return Position::from_raw(saturate_to_int64(round_shift(sum, Unit::frac_bits)));
  }

  // A volume, area or moment in units of 2^exponent, times density over mass; 32 bits.
  [[nodiscard]] std::int64_t over_mass(std::int64_t x, int exponent) const {
    constexpr int k_dropped = 18;
    const Int128 product = multiply_wide(x, std::int64_t{fluid_.density.raw});
    const std::int64_t of_density = saturate_to_int64(round_shift(product, k_dropped));
    const std::int64_t value =
        scale_saturating(of_density, body_.inverse_mass_value(),
                         exponent + k_dropped + 32 - k_submerged_bits - Density::frac_bits);
    return std::clamp(value, -k_most_share, k_most_share);
  }

  void add_moment(const Piece& piece, const SubmergedPart& part, std::int64_t share) {
    Vec3<Position> moment;
    for (int i = 0; i < 3; ++i)
      moment[i].raw = over_mass(part.moment[static_cast<std::size_t>(i)], 4 * part.scale);
    const Vec3<Position> reference =
        piece.origin + rotate(piece.rotation, rounded<Position>(part.reference)) - centre_;
    moment = rotate(piece.rotation, moment);
    for (int i = 0; i < 3; ++i) {
      const Int128 arm = round_shift(multiply_wide(share, reference[i].raw), 32);
      const std::int64_t sum = raw::saturating_add(
          total_.moment[i].raw, raw::saturating_add(moment[i].raw, saturate_to_int64(arm)));
      constexpr std::int64_t k_most = k_most_share << 10;
      total_.moment[i].raw = std::clamp(sum, -k_most, k_most);
    }
  }

  // Of a piece that the surface cuts the part of its volume.
  void add_shadow(const Piece& piece, const ConvexSolid& solid, const SubmergedPart& part) {
    const geometry::Shadow shadow =
        geometry::shadow_of(solid, rotate_inverse(piece.rotation, along_));
    std::int64_t area = shadow.area;
    if (part.plane_area != 0) {
      const std::int64_t volume = std::max(geometry::whole(solid).volume, part.volume);
      area = round_divide(multiply_wide(area, part.volume), volume);
    }
    total_.shadow = std::min(total_.shadow + over_mass(area, 2 * shadow.scale), k_most_share);
  }

  const BodyRecord& body_;
  const Vec3<Position> centre_;
  const FluidRecord& fluid_;
  const Vec3<Unit> up_;
  const Vec3<Unit> along_;
  Immersion total_;
};

}  // namespace

Immersion immersion_of(const BodyRecord& body, const PlacedShape& placed, const FluidRecord& fluid,
                       const Vec3<Unit>& along) {
  ImmersedPieces pieces(body, placed, fluid, along);
  visit_pieces(placed, oriented_box(placed), {}, pieces);
  return pieces.total();
}

}  // namespace lockstone
