#include "core/collision/continuous/face_clamp.h"

#include <lockstone/assert.h>

#include "core/collision/continuous/shrunk_core.h"
#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone {
namespace {

using geometry::FrontCrossing;
using geometry::PointWay;

// How far before the front it is left: surely before it in the next tick.
constexpr Length k_front_gap = geometry::k_front_margin * 4;

Vec3<Position> to_local(const PlacedShape& placed, const Vec3<Position>& point) {
  return rotate_inverse(placed.rotation, point - placed.origin);
}

Vec3<Position> to_world(const PlacedShape& placed, const Vec3<Position>& point) {
  return placed.origin + rotate(placed.rotation, point);
}

class ThinPieces final : public PieceVisitor {
 public:
  ThinPieces(const PlacedWay& a, const PlacedShape& mesh) : a_(a), mesh_(mesh) {}

  void visit(const Piece& piece) override {
    if (inner_radius_of(piece) > k_thin_radius) return;
    const Vec3<Position> middle = middle_of(piece);
    const Vec3<Position> end = to_world(a_.end, to_local(a_.start, middle));
    const PointWay way{saturated<Length>(to_local(mesh_, middle)),
                       saturated<Length>(to_local(mesh_, end))};
    LKS_ASSERT(mesh_.asset != nullptr);
    const geometry::AssetGeometry& asset = *mesh_.asset->triangles();
    const FrontCrossing crossing = asset.mesh_kernels()->first_crossing(asset, way);
    if (!crossing.found || (best_.found && crossing.fraction >= best_.fraction)) return;
    LKS_ASSERT(crossing.fraction >= Unit{} && crossing.fraction <= Unit::from_integer(1));
    best_ = {true, crossing.fraction, push_of(crossing), middle - end};
  }

  [[nodiscard]] const FrontPush& best() const { return best_; }

 private:
  [[nodiscard]] Vec3<Position> push_of(const FrontCrossing& crossing) const {
    const geometry::Fine way = geometry::fine(k_front_gap) - crossing.height;
    LKS_ASSERT(crossing.found);
    const geometry::RawVec push = geometry::along(crossing.normal, way);
    constexpr int k_bits = geometry::k_fine_bits - Position::frac_bits;
    const auto lane = [](geometry::Fine x) {
      return Position::from_raw(raw::round_shift(x, k_bits));
    };
    return rotate(mesh_.rotation, Vec3<Position>{lane(push.x), lane(push.y), lane(push.z)});
  }

  const PlacedWay& a_;
  const PlacedShape& mesh_;
  FrontPush best_;
};

}  // namespace

FrontPush find_front_push(const PlacedWay& a, const PlacedShape& mesh) {
  LKS_ASSERT(mesh.asset != nullptr && mesh.asset->mesh_kernels() != nullptr);
  ThinPieces pieces(a, mesh);
  visit_pieces(a.start, oriented_box(a.start), {}, pieces);
  return pieces.best();
}

}  // namespace lockstone
