// Rollback: the simulation runs ahead of the confirmed ticks on guesses, and goes back when one was
// wrong. Only confirmed ticks are hashed for the server and told as stepped.
//
// The scheme is that of GGPO (Tony Cannon, "Fight the Lag! The Trick Behind GGPO's Low-Latency
// Netcode", 2012), with a server that confirms ticks instead of peers that confirm inputs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

/// Steps guessed ticks, keeps the states before them, and steps again from the first wrong guess.
class Prediction {
 public:
  explicit Prediction(ClientData& data) : data_(data) {}

  /// Takes the memory for the simulation at hand. With `keeps_states`, the states of confirmed
  /// ticks are kept as well, for reports of a difference.
  void reserve(bool keeps_states);

  /// The simulation stands after `ticks` confirmed ticks.
  void restart(std::uint64_t ticks);

  /// The ticks that the simulation has stepped, confirmed or guessed; without prediction the ticks
  /// at the last restart.
  [[nodiscard]] std::uint64_t head() const { return head_; }

  /// The next tick is confirmed: either its inputs are as guessed, or all ticks since are stepped
  /// again. Returns the hash of the state after it.
  std::uint64_t confirm_next();

  /// Steps guessed ticks, as far ahead as the own inputs and the configuration allow.
  void advance();

  /// Goes back to the last confirmed tick.
  void drop_guesses();

  /// Steps the last confirmed ticks again, from a kept state, if that is due: in full, and then
  /// from the history of that. False: the hashes are not those that the ticks had.
  [[nodiscard]] bool passes_sync_test();

  /// The canonical form of the state that was kept after this many ticks. Returns its size; 0: not
  /// kept.
  std::size_t save_kept_state(std::uint64_t ticks, std::span<std::byte> out);

 private:
  void keep_state();
  [[nodiscard]] bool repeats(std::uint64_t from);
  [[nodiscard]] std::uint64_t step(ByteView record, std::span<const PlayerCommand> commands);
  [[nodiscard]] bool guessed_right() const;
  void roll_back(std::uint64_t tick);
  void predict_one();
  void guess_slot(std::span<std::byte> record, std::uint8_t slot);

  ClientData& data_;
  std::uint64_t head_ = 0;
  std::uint64_t stepped_before_ = 0;  ///< as many ticks were stepped before the last rollback
  TickRing states_;   ///< native snapshots, by the ticks stepped before
  TickRing guesses_;  ///< the records stepped
  std::vector<std::uint64_t> guess_hashes_;
  std::uint64_t sync_tested_ = 0;  ///< the confirmed ticks at the last test
};

}  // namespace lockstone::net
