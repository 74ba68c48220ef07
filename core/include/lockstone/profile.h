// Where the time of steps goes, told by a clock that the caller brings.
//
// The library has no clock of its own, and nothing that it computes depends on one: a profile is
// not state, is neither saved nor hashed, and without a clock nothing is counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <lockstone/shape.h>

namespace lockstone {

/// Returns ascending ticks of any unit. Called during `World::step`, so it must not use the world.
using ProfileClock = std::uint64_t (*)();

/// The stages of a tick, in their order, with the name that people read.
#define LKS_STEP_STAGES(X) \
  X(find_pairs)            \
  X(collide)               \
  X(prepare)               \
  X(solve)                 \
  X(store)                 \
  X(move)                  \
  X(continuous)            \
  X(refresh)               \
  X(events)                \
  X(sleep)

enum class StepStage : std::uint8_t {
#define LKS_NAME_STAGE(name) name,
  LKS_STEP_STAGES(LKS_NAME_STAGE)
#undef LKS_NAME_STAGE
};

#define LKS_COUNT_STAGE(name) +1
inline constexpr std::size_t k_step_stages = 0 LKS_STEP_STAGES(LKS_COUNT_STAGE);
#undef LKS_COUNT_STAGE

[[nodiscard]] constexpr const char* name_of(StepStage stage) {
  constexpr const char* k_names[] = {
#define LKS_QUOTE_STAGE(name) #name,
      LKS_STEP_STAGES(LKS_QUOTE_STAGE)
#undef LKS_QUOTE_STAGE
  };
  return k_names[static_cast<std::size_t>(stage)];
}

[[nodiscard]] constexpr std::string_view to_string(StepStage stage) {
  return name_of(stage);
}

/// A hash of the data after each stage of a step. Two equal steps have equal digests; two steps
/// that diverge have different ones from the first diverging stage on.
struct StageDigests {
  std::uint64_t before = 0;  ///< of the step's input: the state after the tick's commands
  std::array<std::uint64_t, k_step_stages> after{};

  friend bool operator==(const StageDigests&, const StageDigests&) = default;
};

/// How closely to look. A pair takes about as long as a few calls of a clock: `pairs` makes the
/// stage `collide` slower than it is without.
enum class ProfileDetail : std::uint8_t {
  stages,  ///< two calls of the clock a stage
  pairs,   ///< and two a pair of bodies, which are then collided on the calling thread alone
};
[[nodiscard]] std::string_view to_string(ProfileDetail detail);

/// The narrow phase's work for pairs of two kinds of shape.
struct PairProfile {
  std::uint64_t pairs = 0;       ///< pairs of bodies with overlapping bounds, triggers included
  std::uint64_t in_contact = 0;  ///< of these, pairs with a manifold
  std::uint64_t manifolds = 0;   ///< a pair has several where a body has parts
  std::uint64_t reused = 0;      ///< manifolds of the tick before, taken as they were
  std::uint64_t parted = 0;      ///< pairs without contact that last tick's axis showed to be apart
  std::uint64_t ticks = 0;       ///< of the clock: finding manifolds and noting them down
};

/// Sums over all steps since the clock was set.
struct StepProfile {
  static constexpr std::size_t k_kinds = static_cast<std::size_t>(k_last_shape_kind) + 1;

  std::uint64_t steps = 0;
  std::array<std::uint64_t, k_step_stages> stage_ticks{};
  std::array<std::array<PairProfile, k_kinds>, k_kinds> pair_kinds{};  ///< [lower][higher kind]

  [[nodiscard]] std::uint64_t ticks_of(StepStage stage) const {
    return stage_ticks[static_cast<std::size_t>(stage)];
  }

  /// Of two kinds in either order.
  [[nodiscard]] const PairProfile& pairs_of(ShapeKind a, ShapeKind b) const {
    return pair_kinds[static_cast<std::size_t>(a < b ? a : b)]
                     [static_cast<std::size_t>(a < b ? b : a)];
  }
};

}  // namespace lockstone
