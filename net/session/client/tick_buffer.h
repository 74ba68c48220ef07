// Confirmed ticks as they come from the server: in any order, with gaps.
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/bytes.h>
#include <lockstone/net/wire.h>

#include "net/session/tick_ring.h"

namespace lockstone::net {

/// Keeps the records of the last ticks, knows up to which one they are complete, and tells when to
/// ask for those that lack between others.
class TickBuffer {
 public:
  TickBuffer() = default;
  TickBuffer(std::size_t history_ticks, std::size_t record_bytes)
      : records_(history_ticks, record_bytes) {}

  /// Ticks below are here.
  [[nodiscard]] std::uint64_t received() const { return received_; }

  [[nodiscard]] bool has(std::uint64_t tick) const { return records_.has(tick); }
  /// The record of a tick, or an empty view if it is not kept.
  [[nodiscard]] ByteView find(std::uint64_t tick) const { return records_.find(tick); }

  void put(std::uint64_t tick, ByteView record);

  /// Moves `received` on by one tick, if that one is here.
  bool advance();

  /// Forgets all records, and that any came from tick `end` on: the server may confirm other ones.
  void clear(std::uint64_t end);

  /// Ticks below `ticks` are not needed.
  void restart(std::uint64_t ticks, std::int64_t now_us);

  /// The range to ask for now, if one is due. One request for each gap would cost as many round
  /// trips as there are gaps, so it asks for all at once.
  [[nodiscard]] std::optional<Resend> missing(std::int64_t now_us, std::int64_t round_trip_us);

 private:
  TickRing records_;
  std::uint64_t received_ = 0;
  std::uint64_t end_ = 0;       ///< no tick from here on has come
  std::uint64_t gap_tick_ = 0;  ///< `received` when a gap was last looked for
  std::int64_t gap_since_us_ = 0;
  std::int64_t last_request_us_ = 0;
};

}  // namespace lockstone::net
