#include "tools/bench/accuracy/reference_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/predicates.h"

namespace lockstone::bench {
namespace {

using Face = std::array<std::size_t, 3>;

template <class T>
Long3 real(const Vec3<T>& v) {
  const auto lane = [](T x) { return std::ldexp(static_cast<Long>(x.raw), -T::frac_bits); };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

Long3 minus(const Long3& a, const Long3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Long determinant(const Long3& a, const Long3& b, const Long3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// The hull of points, one taken in after the other. No point lies in a plane with a horizon's edge
// that it sees a face beyond, so no face is without area.
class GrownHull {
 public:
  explicit GrownHull(std::span<const Vec3<Length>> points) {
    for (const Vec3<Length>& p : points)
      points_.push_back({p.x.raw, p.y.raw, p.z.raw});
    begin();
    for (std::size_t i = 0; i < points_.size(); ++i)
      take(i);
  }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

 private:
  // +1 where the point is outside the face.
  [[nodiscard]] int side(const Face& f, std::size_t p) const {
    return orient3d(points_[f[0]], points_[f[1]], points_[f[2]], points_[p]);
  }

  [[nodiscard]] bool is_line(std::size_t a, std::size_t b, std::size_t c) const {
    const auto lane = [&](std::size_t p, int axis) {
      return static_cast<Long>(points_[p][axis]) - static_cast<Long>(points_[a][axis]);
    };
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (lane(b, i) * lane(c, j) != lane(b, j) * lane(c, i)) return false;  // exact: 62 bits
    }
    return true;
  }

  void begin() {
    std::size_t c = 2;
    while (is_line(0, 1, c))
      ++c;
    std::size_t d = 2;
    while (side({0, 1, c}, d) == 0)
      ++d;
    Face base{0, 1, c};
    if (side(base, d) > 0) std::swap(base[1], base[2]);
    faces_ = {base, {base[1], base[0], d}, {base[2], base[1], d}, {base[0], base[2], d}};
  }

  void take(std::size_t p) {
    std::vector<Face> kept;
    std::vector<std::array<std::size_t, 2>> edges;
    for (const Face& f : faces_) {
      if (side(f, p) <= 0) {
        kept.push_back(f);
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i)
        add_edge({f[i], f[(i + 1) % 3]}, edges);
    }
    for (const auto& [from, to] : edges)
      kept.push_back({from, to, p});
    faces_ = std::move(kept);
  }

  static void add_edge(std::array<std::size_t, 2> edge,
                       std::vector<std::array<std::size_t, 2>>& edges) {
    const auto back = std::find(edges.begin(), edges.end(), std::array{edge[1], edge[0]});
    if (back == edges.end())
      edges.push_back(edge);
    else
      edges.erase(back);
  }

  std::vector<LatticePoint> points_;
  std::vector<Face> faces_;
};

// Adds the tetrahedron of three corners and the origin: its volume, its first moments, its seconds.
void add_tetrahedron(const std::array<Long3, 3>& c, MassReference& sum) {
  const Long volume = determinant(c[0], c[1], c[2]) / 6;
  sum.volume += volume;
  for (std::size_t i = 0; i < 3; ++i) {
    const Long total = c[0][i] + c[1][i] + c[2][i];
    sum.centre[i] += volume * total / 4;
    for (std::size_t j = 0; j < 3; ++j) {
      const Long other = c[0][j] + c[1][j] + c[2][j];
      const Long own = c[0][i] * c[0][j] + c[1][i] * c[1][j] + c[2][i] * c[2][j];
      sum.second[i][j] += volume / 20 * (total * other + own);
    }
  }
}

// From sums about the origin to means about the centre.
void reduce(MassReference& mass) {
  for (Long& x : mass.centre)
    x /= mass.volume;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      mass.second[i][j] = mass.second[i][j] / mass.volume - mass.centre[i] * mass.centre[j];
}

// The columns of the quaternion's matrix, divided by its squared norm.
Long33 axes_of(const Quat& q) {
  const Long3 v = real(Vec3<Unit>{q.x, q.y, q.z});
  const Long w = std::ldexp(static_cast<Long>(q.w.raw), -Unit::frac_bits);
  const Long s = 2 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + w * w);
  Long33 axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    axes[i][i] = 1 - s * (v[j] * v[j] + v[k] * v[k]);
    axes[i][j] = s * (v[i] * v[j] + v[k] * w);
    axes[i][k] = s * (v[i] * v[k] - v[j] * w);
  }
  return axes;
}

Long3 turned(const Long33& axes, const Long3& v) {
  Long3 sum{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum[j] += axes[i][j] * v[i];
  return sum;
}

MassReference placed(const MassReference& own, const CompoundChild& child) {
  const Long33 axes = axes_of(child.orientation);
  MassReference mass{own.volume, turned(axes, own.centre), {}};
  const Long3 at = real(child.position);
  for (std::size_t i = 0; i < 3; ++i)
    mass.centre[i] += at[i];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 9; ++k)
        mass.second[i][j] += axes[k / 3][i] * own.second[k / 3][k % 3] * axes[k % 3][j];
  return mass;
}

}  // namespace

MassReference mass_of_hull(std::span<const Vec3<Length>> points) {
  const GrownHull hull(points);
  const Long3 apex = real(points[0]);
  MassReference sum;
  for (const auto& [a, b, c] : hull.faces())
    add_tetrahedron(
        {minus(real(points[a]), apex), minus(real(points[b]), apex), minus(real(points[c]), apex)},
        sum);
  reduce(sum);
  for (std::size_t i = 0; i < 3; ++i)
    sum.centre[i] += apex[i];
  return sum;
}

MassReference mass_of_primitive(const Shape& shape) {
  const Long3 size = real(shape.size);
  constexpr Long k_pi = std::numbers::pi_v<Long>;
  MassReference mass;
  if (shape.kind == ShapeKind::box) {
    mass.volume = 8 * size[0] * size[1] * size[2];
    for (std::size_t i = 0; i < 3; ++i)
      mass.second[i][i] = size[i] * size[i] / 3;
    return mass;
  }
  // A ball cut in two, and a cylinder of half height h between the halves.
  const Long r = size[0], h = shape.kind == ShapeKind::capsule ? size[1] : 0;
  const Long ball = k_pi * r * r * r * 4 / 3, side = 2 * k_pi * r * r * h;
  mass.volume = ball + side;
  mass.second[0][0] = (ball * r * r / 5 + side * r * r / 4) / mass.volume;
  mass.second[2][2] = mass.second[0][0];
  mass.second[1][1] = (ball * (r * r / 5 + h * h + h * r * 3 / 4) + side * h * h / 3) / mass.volume;
  return mass;
}

MassReference mass_of_compound(std::span<const CompoundChild> children) {
  MassReference sum;
  for (const CompoundChild& child : children) {
    const bool is_hull = child.shape.kind == ShapeKind::hull;
    const MassReference own = is_hull
                                  ? mass_of_hull(static_cast<const Hull&>(*child.asset).vertices())
                                  : mass_of_primitive(child.shape);
    MassReference part = placed(own, child);
    part.volume *= std::ldexp(static_cast<Long>(child.density.raw), -Number::frac_bits);
    sum.volume += part.volume;
    for (std::size_t i = 0; i < 3; ++i) {
      sum.centre[i] += part.volume * part.centre[i];
      for (std::size_t j = 0; j < 3; ++j)
        sum.second[i][j] += part.volume * (part.second[i][j] + part.centre[i] * part.centre[j]);
    }
  }
  reduce(sum);
  return sum;
}

}  // namespace lockstone::bench
