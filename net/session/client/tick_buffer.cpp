#include "net/session/client/tick_buffer.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::int64_t k_request_interval_us = 100'000;
constexpr std::int64_t k_gap_patience_us = 30'000;
constexpr std::uint64_t k_max_request_ticks = 64;

}  // namespace

void TickBuffer::put(std::uint64_t tick, ByteView record) {
  LKS_ASSERT(tick >= received_);
  records_.put(tick, record);
  end_ = std::max(end_, tick + 1);
}

bool TickBuffer::advance() {
  if (!records_.has(received_)) return false;
  ++received_;
  return true;
}

void TickBuffer::clear(std::uint64_t end) {
  records_.clear();
  end_ = end;
}

void TickBuffer::restart(std::uint64_t ticks, std::int64_t now_us) {
  received_ = ticks;
  end_ = std::max(end_, ticks);
  gap_tick_ = ticks;
  gap_since_us_ = now_us;
  while (advance()) {
  }
}

// Packets that were merely overtaken get a moment to arrive. `received_` itself lacks, so the range
// that is asked for is never empty.
std::optional<Resend> TickBuffer::missing(std::int64_t now_us, std::int64_t round_trip_us) {
  if (gap_tick_ != received_ || received_ == end_) {
    gap_tick_ = received_;
    gap_since_us_ = now_us;
    return std::nullopt;
  }
  if (now_us - gap_since_us_ < k_gap_patience_us) return std::nullopt;
  if (now_us - last_request_us_ < k_request_interval_us + round_trip_us) return std::nullopt;
  LKS_ASSERT(received_ < end_ && !records_.has(received_));
  std::uint64_t end = std::min(end_, received_ + k_max_request_ticks);
  while (records_.has(end - 1))
    --end;
  last_request_us_ = now_us;
  return Resend{received_, static_cast<std::uint16_t>(end - received_)};
}

}  // namespace lockstone::net
