// Takes a step's times by the caller's clock; without one each timer is a test of a null pointer.
#pragma once

#include <lockstone/profile.h>

namespace lockstone {

/// Called after each stage.
using StageHook = void (*)(void* context, StepStage stage);

class Profiler {
 public:
  void set_hook(StageHook hook, void* context) {
    hook_ = hook;
    hook_context_ = context;
  }

  void set_clock(ProfileClock now, ProfileDetail detail) {
    now_ = now;
    pair_clock_ = detail == ProfileDetail::pairs ? now : nullptr;
    profile_ = {};
  }

  [[nodiscard]] const StepProfile& profile() const { return profile_; }

  /// Then pairs are collided on one thread alone.
  [[nodiscard]] bool times_pairs() const { return pair_clock_ != nullptr; }

  void count_step() { profile_.steps += now_ != nullptr ? 1U : 0U; }

 private:
  friend class StageTimer;
  friend class PairTimer;

  ProfileClock now_ = nullptr;
  ProfileClock pair_clock_ = nullptr;
  StageHook hook_ = nullptr;
  void* hook_context_ = nullptr;
  StepProfile profile_;
};

/// Adds its own lifetime to a stage; at its end the hook is called, whose time is not counted.
class StageTimer {
 public:
  StageTimer(Profiler& profiler, StepStage stage) : profiler_(profiler), stage_(stage) {
    if (profiler_.now_ != nullptr) begin_ = profiler_.now_();
  }
  ~StageTimer() {
    if (profiler_.now_ != nullptr) {
      profiler_.profile_.stage_ticks[static_cast<std::size_t>(stage_)] += profiler_.now_() - begin_;
    }
    if (profiler_.hook_ != nullptr) profiler_.hook_(profiler_.hook_context_, stage_);
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Profiler& profiler_;
  StepStage stage_;
  std::uint64_t begin_ = 0;
};

/// The same for one pair of bodies in the narrow phase.
class PairTimer {
 public:
  PairTimer(Profiler& profiler, ShapeKind a, ShapeKind b)
      : now_(profiler.pair_clock_),
        total_(profiler.profile_.pair_kinds[static_cast<std::size_t>(a < b ? a : b)]
                                           [static_cast<std::size_t>(a < b ? b : a)]) {
    if (now_ != nullptr) begin_ = now_();
  }
  ~PairTimer() {
    if (now_ == nullptr) return;
    total_.ticks += now_() - begin_;
    ++total_.pairs;
  }
  PairTimer(const PairTimer&) = delete;
  PairTimer& operator=(const PairTimer&) = delete;

  /// The pair's manifolds, and how many of them are those of the tick before.
  void found(int manifolds, int reused = 0) {
    if (now_ == nullptr) return;
    total_.in_contact += manifolds > 0 ? 1U : 0U;
    total_.manifolds += static_cast<std::uint64_t>(manifolds);
    total_.reused += static_cast<std::uint64_t>(reused);
  }

  /// By the axis that parted the pair in the tick before.
  /// Without a clock nothing is written: pairs are then collided side by side.
  void found_apart() {
    if (now_ != nullptr) ++total_.parted;
  }

 private:
  ProfileClock now_;
  PairProfile& total_;
  std::uint64_t begin_ = 0;
};

}  // namespace lockstone
