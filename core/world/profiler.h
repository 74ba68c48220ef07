// Takes a step's times by the caller's clock; without one each timer is a test of a null pointer.
#pragma once

#include <lockstone/profile.h>

namespace lockstone {

class Profiler {
 public:
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
  StepProfile profile_;
};

/// Adds its own lifetime to a stage.
class StageTimer {
 public:
  StageTimer(Profiler& profiler, StepStage stage)
      : now_(profiler.now_),
        total_(profiler.profile_.stage_ticks[static_cast<std::size_t>(stage)]) {
    if (now_ != nullptr) begin_ = now_();
  }
  ~StageTimer() {
    if (now_ != nullptr) total_ += now_() - begin_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  ProfileClock now_;
  std::uint64_t& total_;
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

 private:
  ProfileClock now_;
  PairProfile& total_;
  std::uint64_t begin_ = 0;
};

}  // namespace lockstone
