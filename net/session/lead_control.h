// How early a client sends its inputs: from the margins that the server reports.
//
// Too late costs inputs, too early costs delay. The lead grows by whole ticks at once when inputs
// came late twice within 60 ticks, and shrinks by one when there was time to spare for 3 s. In
// between, the local clock runs up to 5 % fast or slow, which also follows a skewed clock.
#pragma once

#include <algorithm>
#include <cstdint>

namespace lockstone::net {

class LeadControl {
 public:
  static constexpr std::uint64_t k_late_span_ticks = 60;
  static constexpr std::int64_t k_lower_us = 3'000'000;
  static constexpr std::int32_t k_max_trim_ppm = 50'000;

  explicit LeadControl(std::uint32_t most_ticks = 0) : most_ticks_(most_ticks) {}

  /// A margin in quarter ticks of inputs up to `tick`; inputs up to `sampled` are on their way.
  void note(std::int32_t margin_quarters, std::uint64_t tick, std::uint64_t sampled,
            std::int64_t now_us);

  [[nodiscard]] std::uint32_t lead_ticks() const { return lead_ticks_; }
  /// By how much the local clock shall run fast.
  [[nodiscard]] std::int32_t trim_ppm() const { return trim_ppm_; }
  [[nodiscard]] std::int32_t last_margin() const { return last_margin_; }

 private:
  void raise(std::int32_t margin_quarters, std::uint64_t tick, std::uint64_t sampled);
  void lower(std::int64_t now_us);

  std::uint32_t most_ticks_;
  std::uint32_t lead_ticks_ = 0;
  std::int32_t trim_ppm_ = 0;
  std::int32_t last_margin_ = 0;
  bool late_before_ = false;
  std::uint64_t late_tick_ = 0;  ///< when inputs were last late
  std::uint64_t hold_tick_ = 0;  ///< margins of inputs below were before the last raise
  std::int64_t window_since_us_ = -1;
  std::int32_t window_least_ = 0;  ///< the least margin since then
};

}  // namespace lockstone::net
