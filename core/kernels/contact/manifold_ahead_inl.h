// Prefetches of the blocks and bodies that an iteration reads next.
#if defined(LKS_WIDE_MANIFOLD_AHEAD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_AHEAD_INL_H
#undef LKS_WIDE_MANIFOLD_AHEAD_INL_H
#else
#define LKS_WIDE_MANIFOLD_AHEAD_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include "core/kernels/contact/body_velocities_inl.h"
#include "core/kernels/contact/manifold_block.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// Prefetches the next block, some cache lines at a time, while the present one is solved. Hardware
/// does not look a whole block ahead, and cannot wait for this many lines at once. Results do not
/// depend on it.
class Ahead {
 public:
  HWY_INLINE HWY_ATTR explicit Ahead(const void* from) : from_(static_cast<const char*>(from)) {}

  HWY_INLINE HWY_ATTR void ask(std::size_t lines) {
#if defined(__GNUC__)
    for (std::size_t i = 0; i < lines; ++i)
      __builtin_prefetch(from_ + 64 * i);
#endif
    from_ += 64 * lines;
  }

 private:
  const char* from_;
};

/// The bodies of a block, or other records of the same form, from `lane` on.
HWY_INLINE HWY_ATTR void ask_for_bodies(const std::int64_t* words, const ManifoldBlock& block,
                                        std::size_t lane) {
  for (std::size_t i = lane; i < lane + k_lanes; ++i) {
    Ahead(words + block.body_a[i]).ask(1);
    Ahead(words + block.body_b[i]).ask(1);
  }
}

/// This many lines make `stages` of all that lie in `bytes`, with as many vectors as a block has.
constexpr std::size_t lines_of(std::size_t bytes, std::size_t stages) {
  const std::size_t parts = stages * (k_block_lanes / k_lanes);
  return (bytes / 64 + parts - 1) / parts;
}

/// Cache lines that an iteration reads of plain manifolds after the indices of their bodies:
/// without friction, and with it.
inline constexpr std::size_t k_normal_lines =
    lines_of(offsetof(ManifoldBlock, coupling) - offsetof(ManifoldBlock, axes), 5);
inline constexpr std::size_t k_friction_lines =
    lines_of(offsetof(ManifoldBlock, inertia) - offsetof(ManifoldBlock, axes), 7);

/// The i-th block, or the last.
HWY_INLINE HWY_ATTR const ManifoldBlock& block_at(const ManifoldBlock* blocks, std::size_t i,
                                                  std::size_t count) {
  return blocks[i < count ? i : count - 1];
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
