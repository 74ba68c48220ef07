#include "core/geometry/submerged/sliced_solid.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/math/int128.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

constexpr std::int64_t k_one = std::int64_t{1} << 30;

// −cos φ and sin φ·weight·π/2 of the 16 points of Gauss and Legendre in φ, 30 fraction bits.
struct Node {
  std::int32_t place;
  std::int32_t weight;
};
constexpr Node k_nodes[] = {
    {-1073593013, 762424},   {-1069675085, 9129780},  {-1049913494, 33624539},
    {-995460557, 78789673},  {-886052690, 142516340}, {-707565674, 214596726},
    {-459622772, 278341378}, {-159656675, 315980964}, {159656675, 315980964},
    {459622772, 278341378},  {707565674, 214596726},  {886052690, 142516340},
    {995460557, 78789673},   {1049913494, 33624539},  {1069675085, 9129780},
    {1073593013, 762424}};

std::int64_t root_of(std::int64_t square) {
  return static_cast<std::int64_t>(
      isqrt_rounded(static_cast<std::uint64_t>(std::max<std::int64_t>(square, 0))));
}

// A disc of radius 1 cut at x = q: the area of the part where x ≤ q, 32 bits; and the half chord.
struct DiscSegment {
  std::int64_t area = 0;
  std::int64_t half_chord = 0;
};
DiscSegment segment_at(std::int64_t q) {
  LKS_ASSERT(q >= -k_one && q <= k_one);
  const std::int64_t half = root_of(k_one * k_one - q * q);
  const std::int64_t angle = fine_arc(static_cast<std::uint64_t>(half), -q).raw;  // acos(−q)
  return {angle + raw::round_shift(q * half, 28), half};
}

}  // namespace

std::int64_t Outline::radius_at(std::int64_t y) const {
  if (arc_radius != 0) {
    const std::int64_t up = y - arc_centre;
    return root_of(arc_radius * arc_radius - up * up);
  }
  if (r0 == r1 || y1 == y0) return r0;
  return r0 + round_divide(multiply_wide(r1 - r0, y - y0), y1 - y0);
}

SlicedSolid::SlicedSolid(const Vec3<Unit>& normal, std::int64_t offset)
    : normal_(normal),
      offset_(offset),
      across_(root_of(std::int64_t{normal.x.raw} * normal.x.raw +
                      std::int64_t{normal.z.raw} * normal.z.raw)) {}

// How far the plane is from the axis at a height, times `across_`.
std::int64_t SlicedSolid::depth_at(std::int64_t y) const {
  return offset_ - product_q30(normal_.y.raw, y);
}

// Where the plane touches the side of the solid that it meets first, or last.
std::int64_t SlicedSolid::break_of_line(const Outline& line, std::int64_t sign) const {
  const std::int64_t first = depth_at(line.y0) - sign * product_q30(across_, line.r0);
  const std::int64_t last = depth_at(line.y1) - sign * product_q30(across_, line.r1);
  if ((first < 0) == (last < 0)) return line.y0;
  const bool rises = last > first;
  const std::int64_t part = rises ? -first : first;
  return line.y0 +
         round_divide(multiply_wide(line.y1 - line.y0, part), rises ? last - first : first - last);
}

SlicedSolid::Breaks SlicedSolid::breaks_of(const Outline& outline) const {
  if (outline.arc_radius == 0) return {break_of_line(outline, 1), break_of_line(outline, -1)};
  const std::int64_t depth = depth_at(outline.arc_centre);
  const std::int64_t square = outline.arc_radius * outline.arc_radius;
  if (depth >= outline.arc_radius || depth <= -outline.arc_radius) return {outline.y0, outline.y0};
  const std::int64_t middle = outline.arc_centre + product_q30(depth, normal_.y.raw);
  const std::int64_t reach = product_q30(across_, root_of(square - depth * depth));
  return {middle - reach, middle + reach};
}

// The section of a plane nearly across the axis: a disc.
void SlicedSolid::add_disc(const Outline& outline) {
  const std::int64_t up = normal_.y.raw, sign = up < 0 ? -1 : 1;
  const std::int64_t y = raw::round_divide(sign * offset_ * k_one, sign * up);
  if (y < outline.y0 || y >= outline.y1) return;
  const std::int64_t r = outline.radius_at(y);
  section_ = saturated_product(r * r, k_pi_q60, 60 + 60 - k_submerged_bits);
}

void SlicedSolid::add(const Outline& outline) {
  if (is_across()) add_disc(outline);
  const Breaks breaks = breaks_of(outline);
  std::int64_t ends[] = {std::clamp(breaks.y[0], outline.y0, outline.y1),
                         std::clamp(breaks.y[1], outline.y0, outline.y1)};
  if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
  add_interval(outline, outline.y0, ends[0]);
  add_interval(outline, ends[0], ends[1]);
  add_interval(outline, ends[1], outline.y1);
}

void SlicedSolid::add_interval(const Outline& outline, std::int64_t y0, std::int64_t y1) {
  if (y1 <= y0) return;
  const std::int64_t middle = y0 + (y1 - y0) / 2, half = y1 - middle;
  std::int64_t volume = 0, along = 0, toward = 0, section = 0;
  for (const Node& node : k_nodes) {
    const std::int64_t y = middle + product_q30(half, node.place);
    const std::int64_t r = outline.radius_at(y), depth = depth_at(y),
                       reach = product_q30(across_, r);
    if (depth <= -reach) continue;
    const std::int64_t q = depth >= reach ? k_one : raw::round_divide(depth * k_one, reach);
    const DiscSegment segment = segment_at(std::clamp(q, -k_one, k_one));
    const Int128 disc_part = multiply_wide(segment.area, product_q30(r, r));
    const std::int64_t area =
        product_q30(saturate_to_int64(round_shift(disc_part, 14)), node.weight);
    const std::int64_t chord = product_q30(r, segment.half_chord);
    const std::int64_t cubed = raw::round_shift(product_q30(chord, chord) * chord, 12);
    volume += area;
    along += product_q30(area, y);
    toward -= product_q30(cubed, node.weight);
    section += product_q30(chord * (std::int64_t{1} << 19), node.weight);
  }
  volume_ += product_q30(volume, half);
  along_ += product_q30(along, half);
  toward_ += product_q30(toward, half);
  if (!is_across()) section_ += product_q30(section, half);
}

void SlicedSolid::finish(SubmergedPart& part) const {
  part.volume = volume_;
  const std::int64_t toward = raw::round_divide(2 * toward_, 3);
  const auto share = [&](Unit component) {
    if (across_ == 0) return std::int64_t{0};
    return round_divide(multiply_wide(toward, component.raw), across_);
  };
  part.moment = {share(normal_.x), along_, share(normal_.z)};
  part.plane_area = is_across() ? section_ : round_divide(multiply_wide(section_, k_one), across_);
}

}  // namespace lockstone::geometry
