// The faults of a match as its time goes on: which of the schedule's events are active now.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/net/transport_sim.h>

#include "net/transport/random.h"
#include "tools/simnet/schedule.h"

namespace lockstone::simnet {

/// Begins with the match; before that, nothing is wrong.
class FaultPlan {
 public:
  FaultPlan(const Schedule& schedule, std::uint64_t seed)
      : schedule_(schedule), active_(schedule.size()), forgery_(seed ^ 0xf0e6e) {}

  void begin(std::int64_t now_us) { started_us_ = now_us; }
  [[nodiscard]] bool has_begun() const { return started_us_ >= 0; }
  /// The time of a moment of the match.
  [[nodiscard]] std::int64_t time_us(std::uint32_t match_ms) const {
    return started_us_ + std::int64_t{match_ms} * 1000;
  }

  /// Calls `change(event, active)` for each event that begins or ends now; returns whether any did.
  template <class Change>
  bool advance(std::int64_t now_us, Change&& change) {
    if (!has_begun()) return false;
    const std::int64_t at_ms = (now_us - started_us_) / 1000;
    bool any = false;
    for (std::size_t i = 0; i < schedule_.size(); ++i) {
      const FaultEvent& event = schedule_[i];
      const bool active = at_ms >= event.from_ms && at_ms < event.until_ms;
      if (active == active_[i]) continue;
      active_[i] = active;
      any = true;
      change(event, active);
    }
    return any;
  }

  /// The faults of a client's connection.
  [[nodiscard]] net::LinkFaults faults_of(std::size_t client) const;

  /// The last moment of a client's death that is under way; 0: none is.
  [[nodiscard]] std::int64_t dead_until_us(std::size_t client) const;

  /// Whether the client was cut off, or stood still, so lately that a message to it and back, and
  /// one more to it, are still on their way.
  [[nodiscard]] bool has_just_come_back(std::size_t client, std::int64_t now_us) const;

  /// Calls `forge(client, bytes)` for each packet that is forged in this step as from one of
  /// `clients`.
  template <class Forge>
  void forge_packets(std::int64_t step_us, std::size_t clients, Forge&& forge) {
    for (std::size_t i = 0; i < schedule_.size(); ++i) {
      const FaultEvent& event = schedule_[i];
      if (!active_[i] || event.kind != FaultKind::forge || event.client >= clients) continue;
      const ByteView bytes = draw_forgery(static_cast<std::uint32_t>(event.amount * step_us));
      if (!bytes.empty()) forge(event.client, bytes);
    }
  }

 private:
  [[nodiscard]] ByteView draw_forgery(std::uint32_t ppm);

  const Schedule& schedule_;
  std::vector<bool> active_;  ///< by event
  net::Random forgery_;
  std::array<std::byte, 64> forged_{};
  std::int64_t started_us_ = -1;
};

}  // namespace lockstone::simnet
