#include "tools/fuzz/verdict.h"

#include <algorithm>
#include <cmath>

namespace lockstone::fuzz {
namespace {

constexpr std::array<CheckText, k_checks> k_texts{{
    {"flip", "bit for bit; spheres' anchors 1 step"},
    {"distance", "2 um"},
    {"witness", "4 um; of depths + 26e-9 of the sizes"},
    {"depth", "2 um + 13e-9 of the sizes"},
    {"turned", "4 um + 26e-9 of the sizes"},
    {"apart",
     "18 um + 13e-9 of the sizes + 1/2000 of a capsule's core distance; with rims + 3.4 um + 6e-9 "
     "of their radii"},
    {"overlap", "15 % and 0.82 mm more"},
    {"margin", "as apart"},
    {"manifold", "normal 2^-29; features ascend"},
    {"anchors",
     "48 um + 13e-9 of the sizes; a capsule's + 1/1000 of its radius; with rims + 1e-4 of the "
     "depth of a single point, of more 2.4e-7 of the sizes, of two 2^-15 of the least radius"},
    {"separated", "implies no points"},
    {"overlaps", "agrees outside 6 um + 13e-9 of the sizes"},
    {"cast", "2 um"},
    {"cast-miss", "2 um + 13e-9 of sizes and way"},
    {"ray", "2 um + 2^-30 of the ray"},
    {"ray-miss", "agrees outside 2 um"},
}};

}  // namespace

CheckText text_of(Check check) {
  return k_texts[static_cast<std::size_t>(check)];
}

void Figure::add(const Figure& other) {
  const bool worse = other.worst_share > worst_share ||
                     (other.worst_share == worst_share && other.worst_index < worst_index);
  if (count == 0 || (other.count > 0 && worse)) worst_index = other.worst_index;
  worst_share = std::max(worst_share, other.worst_share);
  worst = std::max(worst, other.worst);
  count += other.count;
  failures += other.failures;
}

void Verdict::measure(Check check, double error, double allowed) {
  const double size = std::abs(error);
  const bool holds = size <= allowed;  // false for NaN
  figures_[static_cast<std::size_t>(check)].add(
      {1, holds ? std::uint64_t{0} : 1, size, size / allowed, index_});
}

bool Verdict::failed() const {
  return std::ranges::any_of(figures_, [](const Figure& f) { return f.failures > 0; });
}

}  // namespace lockstone::fuzz
