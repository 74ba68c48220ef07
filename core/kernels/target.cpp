#include "core/kernels/target.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "core/kernels/kernel_table.h"

namespace lockstone::lanes {
namespace {

#if !defined(LKS_VECTORS_ALONE)
constexpr Kernels k_scalar{"scalar",
                           1,
                           compute_rotations_scalar,
                           farthest_point_scalar,
                           extent_along_scalar,
                           heights_above_scalar,
                           mark_at_least_scalar,
                           &k_scalar_manifolds,
                           &k_scalar_balls,
                           &k_scalar_boxes,
                           &k_scalar_proximal};
#endif

#if defined(LOCKSTONE_WITH_HIGHWAY) && defined(__x86_64__)
constexpr std::array<std::string_view, 3> k_candidates = {"sse4", "avx2", "avx512"};

// The library of the compiler also asks whether the system saves the wide registers.
bool processor_has(std::string_view target) {
  const bool sse4 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
                    __builtin_cpu_supports("sse4.2");
  if (target == "sse4") return sse4;
  const bool avx2 = sse4 && __builtin_cpu_supports("avx") && __builtin_cpu_supports("avx2");
  if (target == "avx2") return avx2;
  return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
}
#elif defined(LOCKSTONE_WITH_HIGHWAY)
// The compiler was told to use them, so the program could not have started without.
constexpr std::array<std::string_view, 2> k_candidates = {"neon", "wasm"};
bool processor_has(std::string_view) {
  return true;
}
#endif

struct Supported {
  std::array<const Kernels*, 4> kernels{};
  std::array<std::string_view, 4> names{};
  std::size_t count = 0;

  Supported() {
#if !defined(LKS_VECTORS_ALONE)
    add(k_scalar);
#endif
#if defined(LOCKSTONE_WITH_HIGHWAY)
    for (const std::string_view name : k_candidates) {
      const Kernels* found = highway_kernels(name);
      if (found != nullptr && processor_has(name)) add(*found);
    }
#endif
  }

 private:
  void add(const Kernels& found) {
    names[count] = found.target;
    kernels[count++] = &found;
  }
};

const Supported& supported() {
  static const Supported all;
  return all;
}

// Null: the best.
std::atomic<const Kernels*> forced{nullptr};

const Kernels& current() {
  const Kernels* kernels = forced.load(std::memory_order_relaxed);
  return kernels != nullptr ? *kernels : *supported().kernels[supported().count - 1];
}

// The narrowest target that holds all items at once, or the forced one: wide vectors take longer
// than narrow ones, even when most lanes are empty.
const Kernels& narrowest_for(std::size_t items) {
  if (const Kernels* kernels = forced.load(std::memory_order_relaxed)) return *kernels;
  const auto all = std::span(supported().kernels).first(supported().count);
  const auto found =
      std::ranges::find_if(all, [&](const Kernels* kernels) { return kernels->lanes >= items; });
  return found == all.end() ? *all.back() : **found;
}

}  // namespace

std::span<const std::string_view> supported_targets() {
  return std::span(supported().names).first(supported().count);
}

std::string_view current_target() {
  return current().target;
}

Status set_target(std::string_view name) {
  if (name.empty()) {
    forced.store(nullptr, std::memory_order_relaxed);
    return Status::ok;
  }
  const Supported& all = supported();
  for (std::size_t i = 0; i < all.count; ++i) {
    if (all.names[i] != name) continue;
    forced.store(all.kernels[i], std::memory_order_relaxed);
    return Status::ok;
  }
  return Status::not_found;
}

const ManifoldKernels& manifold_kernels(std::size_t manifolds) {
  return *narrowest_for(manifolds).manifolds;
}

const BallKernels& ball_kernels(std::size_t balls) {
  return *narrowest_for(balls).balls;
}

const BoxKernels& box_kernels() {
  return *current().boxes;
}

const ProximalKernels& proximal_kernels() {
  return *current().proximal;
}

void compute_rotations(const QuatField& quats, std::span<const std::uint32_t> indices,
                       Mat3* matrices) {
  current().compute_rotations(quats, indices.data(), indices.size(), matrices);
}

Farthest farthest_point(const PointColumns& points, const Direction32& n) {
  return current().farthest_point(points, n);
}

Extent extent_along(const PointColumns& points, const Direction32& n) {
  return current().extent_along(points, n);
}

Farthest heights_above(const PointColumns& normals, const std::int64_t* offsets,
                       const Direction32& p, std::int64_t* heights) {
  return current().heights_above(normals, offsets, p, heights);
}

void mark_at_least(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                   std::uint64_t* marks) {
  current().mark_at_least(heights, count, bound, marks);
}

}  // namespace lockstone::lanes
