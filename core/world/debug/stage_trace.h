// Work of a world after each stage of a step, beside the step: digests of the data of the stage,
// and validation. Neither changes a result.
#pragma once

#include <cstdint>

#include <lockstone/profile.h>
#include <lockstone/world.h>

namespace lockstone {

class StageTrace {
 public:
  /// `world` outlives this.
  explicit StageTrace(World::Impl& world) : world_(world) {}
  StageTrace(const StageTrace&) = delete;
  StageTrace& operator=(const StageTrace&) = delete;

  /// Takes a digest after each stage from now on, or no longer.
  void take_digests(bool on);
  /// Validates the data of each stage from now on, or no longer.
  void validate(bool on);

  [[nodiscard]] bool is_on() const { return takes_digests_ || validates_; }

  /// Before the first stage of a step.
  void begin_step();
  /// Of the last step.
  [[nodiscard]] const StageDigests& digests() const { return digests_; }

 private:
  void set_hook();
  void after(StepStage stage);
  /// The hash of the data after a stage.
  [[nodiscard]] std::uint64_t digest_of(StepStage stage) const;

  World::Impl& world_;
  bool takes_digests_ = false;
  bool validates_ = false;
  StageDigests digests_{};
};

}  // namespace lockstone
