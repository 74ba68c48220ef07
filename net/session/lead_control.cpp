#include "net/session/lead_control.h"

namespace lockstone::net {
namespace {

// In quarter ticks. Between calm and ample, the clock is left alone.
constexpr std::int32_t k_calm = 4;
constexpr std::int32_t k_ample = 10;
constexpr std::int32_t k_trim_per_quarter_ppm = 5'000;

}  // namespace

void LeadControl::note(std::int32_t margin_quarters, std::uint64_t tick, std::uint64_t sampled,
                       std::int64_t now_us) {
  last_margin_ = margin_quarters;
  if (margin_quarters < 0) {
    raise(margin_quarters, tick, sampled);
    window_since_us_ = -1;
  } else {
    window_least_ =
        window_since_us_ < 0 ? margin_quarters : std::min(window_least_, margin_quarters);
    if (window_since_us_ < 0) window_since_us_ = now_us;
    if (now_us - window_since_us_ >= k_lower_us) lower(now_us);
  }
  const std::int32_t wrong =
      std::max(0, margin_quarters - k_ample) + std::min(0, margin_quarters - k_calm);
  trim_ppm_ = std::clamp(-wrong * k_trim_per_quarter_ppm, -k_max_trim_ppm, k_max_trim_ppm);
}

void LeadControl::raise(std::int32_t margin_quarters, std::uint64_t tick, std::uint64_t sampled) {
  if (tick <= hold_tick_) return;
  const bool twice = late_before_ && tick - late_tick_ <= k_late_span_ticks;
  late_before_ = !twice;
  late_tick_ = tick;
  if (!twice) return;
  hold_tick_ = sampled;
  const auto lacking = static_cast<std::uint32_t>((3 - margin_quarters) / 4);
  lead_ticks_ = std::min(most_ticks_, lead_ticks_ + std::max(1U, lacking));
}

void LeadControl::lower(std::int64_t now_us) {
  const bool spare = window_least_ >= k_calm + 4;
  if (spare && lead_ticks_ > 0) --lead_ticks_;
  window_since_us_ = now_us;
  window_least_ = last_margin_;
}

}  // namespace lockstone::net
