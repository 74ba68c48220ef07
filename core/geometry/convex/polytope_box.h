// A box as a polytope of eight vertices.
#pragma once

#include <array>

#include "core/geometry/convex/polytope.h"

namespace lockstone::geometry {

/// Owns the vertices and faces; the view is valid as long as this is, and where this is.
class BoxPolytope {
 public:
  explicit BoxPolytope(const Vec3<Length>& half_extents, Length radius = {});
  BoxPolytope(const BoxPolytope&) = delete;
  BoxPolytope& operator=(const BoxPolytope&) = delete;

  [[nodiscard]] Polytope view() const;

 private:
  std::array<Vec3<Length>, 8> vertices_;
  std::array<PolytopeFace, 6> faces_;
  Length radius_;
};

}  // namespace lockstone::geometry
