#include "tools/fuzz/surface.h"

namespace lockstone::fuzz {
namespace {

struct Plane {
  Real3 normal;  // world axes, of norm 1
  double offset;
};

Plane plane_of(const Body& body, const geometry::PolytopeFace& face) {
  const Real3 n = turn(body.rotation, real(face.normal));
  const double length = norm(n);
  return {n * (1 / length),
          std::ldexp(static_cast<double>(face.offset), -geometry::k_fine_bits) / length};
}

std::vector<Plane> planes_of(const Body& body) {
  std::vector<Plane> planes;
  if (body.kind == Kind::half_space) return {{direction_of(real(body.rotation.y)), 0}};
  if (body.polytope != nullptr) {
    for (const geometry::PolytopeFace& face : body.polytope->faces)
      planes.push_back(plane_of(body, face));
    return planes;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Real3 n = direction_of(real(body.rotation.column(axis)));
    planes.push_back({n, real(body.shape.size[axis])});
    planes.push_back({-n, real(body.shape.size[axis])});
  }
  return planes;
}

// Distance of a point from a face's polygon.
double to_face(const Body& body, const geometry::PolytopeFace& face, const Real3& point) {
  const geometry::Polytope& p = *body.polytope;
  const auto corner = [&](int i) {
    return body.core[p.edges[static_cast<std::size_t>(face.first_edge + i)].origin];
  };
  double least = 1e30;
  for (int i = 2; i < face.edge_count; ++i)
    least = std::min(least, point_to_triangle(point, corner(0), corner(i - 1), corner(i)));
  return least;
}

// Boxes are the sums of three rounded vectors, square only to 2^-30: at 400 m their corners stand
// off the planes along the vectors by up to 1 µm.
double outside_box(const Body& box, const Real3& point) {
  double square = 0, inside = -1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const Real3 u = real(box.rotation.column(axis));
    const Real3 v = real(box.rotation.column((axis + 1) % 3));
    const Real3 n = direction_of(cross(v, real(box.rotation.column((axis + 2) % 3))));
    const double beyond = std::abs(dot(n, point)) - real(box.shape.size[axis]) * dot(n, u);
    inside = std::max(inside, beyond);
    square += beyond > 0 ? beyond * beyond : 0;
  }
  return square > 0 ? std::sqrt(square) : inside;
}

double highest_plane(const Body& body, const Real3& point) {
  double above = -1e30;
  for (const Plane& plane : planes_of(body))
    above = std::max(above, dot(plane.normal, point) - plane.offset);
  return above;
}

double outside_polytope(const Body& body, const Real3& point) {
  const double above = highest_plane(body, point);
  if (above <= 0) return above;
  double least = 1e30;
  for (const geometry::PolytopeFace& face : body.polytope->faces)
    least = std::min(least, to_face(body, face, point));
  return least;
}

// The profile of a cylinder or a cone in a plane through its axis: x away from the axis, y along
// it.
struct Profile {
  double x;
  double y;
};

double to_side(const Profile& p, const Profile& a, const Profile& b) {
  return point_to_segment({p.x, p.y, 0}, {a.x, a.y, 0}, {b.x, b.y, 0});
}

// The least distance from the sides of the profile, negative inside.
double outside_rims(const Body& body, const Real3& point) {
  const Circle& base = body.rims.front();
  const double y = dot(point, base.axis), x = norm(point - base.axis * y);
  const Profile p{x, y}, foot{0, dot(base.centre, base.axis)}, low{base.radius, foot.y};
  if (body.kind == Kind::cone) {
    const Profile apex{0, dot(body.core.front(), base.axis)};
    const double least = std::min(to_side(p, foot, low), to_side(p, low, apex));
    const double across = (apex.x - low.x) * (y - low.y) - (apex.y - low.y) * (x - low.x);
    return y > low.y && across > 0 ? -least : least;
  }
  const Profile high{base.radius, -low.y}, top{0, high.y};
  const double least =
      std::min({to_side(p, foot, low), to_side(p, low, high), to_side(p, high, top)});
  return x < base.radius && std::abs(y) < high.y ? -least : least;
}

// Of the ball whose centre a line square to the side meets, or of an end's.
double outside_taper(const Body& body, const Real3& point) {
  const Real3 &low = body.core.front(), axis = body.core.back() - low;
  const double length = norm(axis), fall = body.swell[0] - body.swell[1];
  if (length == 0) return norm(point - low) - body.swell[0] - body.radius;
  const double up = dot(point - low, axis) / length;
  const double out = norm(point - low - axis * (up / length));
  const double rise = std::sqrt((length - fall) * (length + fall));
  const double foot = std::clamp(up - out * fall / rise, 0.0, length);
  return std::hypot(out, up - foot) - body.swell[0] + fall * foot / length - body.radius;
}

// The distance from a convex body is convex along a segment.
bool is_form_entered(const Body& body, const Real3& from, const Real3& way, double depth) {
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double first = low + (high - low) / 3, second = high - (high - low) / 3;
    const bool falls = outside(body, from + way * first) > outside(body, from + way * second);
    (falls ? low : high) = falls ? first : second;
  }
  return outside(body, from + way * ((low + high) / 2)) < -depth;
}

double segment_to_segment(const Real3& a, const Real3& u, const Real3& b, const Real3& v) {
  const double ends = std::min({point_to_segment(a, b, b + v), point_to_segment(a + u, b, b + v),
                                point_to_segment(b, a, a + u), point_to_segment(b + v, a, a + u)});
  const Real3 n = cross(u, v);
  const double square = dot(n, n);
  if (square == 0) return ends;
  const Real3 d = b - a;
  const double s = dot(cross(d, v), n) / square, t = dot(cross(d, u), n) / square;
  const bool crossing = s >= 0 && s <= 1 && t >= 0 && t <= 1;
  return crossing ? std::min(ends, std::abs(dot(d, n)) / std::sqrt(square)) : ends;
}

// The part of a segment below a plane.
struct Part {
  double from = 0;
  double to = 1;

  void keep_below(double start, double rise) {
    if (rise == 0) {
      if (start > 0) to = -1;
      return;
    }
    const double at = -start / rise;
    rise > 0 ? to = std::min(to, at) : from = std::max(from, at);
  }
};

bool is_flat_entered(const Body& body, const Real3& from, const Real3& way, double depth) {
  const Plane front = plane_of(body, body.polytope->faces[0]);
  const double start = dot(front.normal, from) - front.offset, rise = dot(front.normal, way);
  if (start < depth || start + rise > -depth) return false;
  const Real3 point = from - way * (start / rise);
  for (std::size_t i = 0; i < 3; ++i) {
    const Real3 &a = body.core[i], &b = body.core[(i + 1) % 3];
    const Real3 inward = direction_of(cross(front.normal, b - a));
    if (dot(inward, point - a) < depth) return false;
  }
  return true;
}

}  // namespace

double outside(const Body& body, const Real3& point) {
  if (body.kind == Kind::half_space) return dot(direction_of(real(body.rotation.y)), point);
  if (body.is_box()) return outside_box(body, point) - body.radius;
  if (body.has_rims()) return outside_rims(body, point);
  if (body.is_tapered()) return outside_taper(body, point);
  if (body.polytope != nullptr) return outside_polytope(body, point) - body.radius;
  return point_to_segment(point, body.core.front(), body.core.back()) - body.radius;
}

double above_planes(const Body& body, const Real3& point) {
  const bool has_two_sides = body.kind == Kind::hull || body.kind == Kind::box;
  return has_two_sides ? highest_plane(body, point) : outside(body, point);
}

bool is_entered(const Body& body, const Real3& from, const Real3& way, double depth) {
  if (body.has_rims() || body.is_tapered() || body.is_rounded())
    return is_form_entered(body, from, way, depth);
  if (body.radius > 0) {
    const Real3 &end = body.core.front(), &axis = body.core.back() - end;
    return segment_to_segment(from, way, end, axis) < body.radius - depth;
  }
  if (body.kind == Kind::triangle) return is_flat_entered(body, from, way, depth);
  Part part;
  for (const Plane& plane : planes_of(body))
    part.keep_below(dot(plane.normal, from) - plane.offset + depth, dot(plane.normal, way));
  return part.from < part.to;
}

}  // namespace lockstone::fuzz
