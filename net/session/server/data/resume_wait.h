// How long a server that was started again waits for its players.
#pragma once

#include <cstdint>

#include <lockstone/net/slot_mask.h>

namespace lockstone::net {

/// From the first player on that is back, the others have a limited time.
class ResumeWait {
 public:
  explicit ResumeWait(std::int64_t patience_us) : patience_us_(patience_us) {}

  /// Bit n: slot n's player is expected.
  void begin(SlotMask expected_mask) { expected_ = expected_mask; }

  [[nodiscard]] bool is_over() const { return expected_ == 0; }

  /// `back_mask`: the players who are here. True if this ends the wait.
  bool advance(SlotMask back_mask, std::int64_t now_us) {
    if (is_over()) return false;
    if (back_mask != 0 && first_back_us_ < 0) first_back_us_ = now_us;
    const bool enough = first_back_us_ >= 0 && now_us - first_back_us_ > patience_us_;
    if (enough || (back_mask & expected_) == expected_) expected_ = 0;
    return is_over();
  }

 private:
  std::int64_t patience_us_;
  SlotMask expected_ = 0;
  std::int64_t first_back_us_ = -1;  ///< when the first one could play
};

}  // namespace lockstone::net
