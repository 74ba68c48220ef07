// The states that a server sends to those who enter a match that runs.
//
// A server that simulates takes a state from itself; a relay fetches the newest one that all agreed
// on from a player, the donor. One state serves all who enter while it is young.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "net/session/server/data/keyframe_store.h"
#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"
#include "net/session/server/desync/dumps.h"

namespace lockstone::net {

/// Provides a state for each follower that waits for one, and sends it in pieces, as fast as
/// configured for all of them together.
class EntryStates {
 public:
  EntryStates(ServerData& data, DumpRequests& dumps, const DesyncCases& cases);

  [[nodiscard]] KeyframeStore& keyframes() { return keyframes_; }

  /// Relay: takes the donor's state if it has come; where the donor fails, the next one is asked.
  void advance();

  /// Offers the entry state to a waiting follower, if there is one that helps it. `slot` of a
  /// player; k_spectator_slot of a spectator.
  void offer(Follower& follower, std::uint8_t slot);

  /// Offers the newest keyframe that a spectator may see.
  void offer_keyframe(Watcher& watcher);

  /// Sends pieces of the offered state.
  void send_pieces(Follower& follower);

  /// Whether the state that is offered to the follower is sent in full. True where none is left.
  [[nodiscard]] bool is_sent(const Follower& follower) const;

  /// A follower found its state wrong. Returns the ticks that a better one must have.
  [[nodiscard]] std::uint64_t reject();

  /// Gives up fetching from the player of `slot`: it has another snapshot to send.
  void release_donor(std::uint8_t slot);

  /// The unfinished transfer of the state after `tick` from `slot`, or null.
  [[nodiscard]] DumpTransfer* transfer_of(std::uint8_t slot, std::uint64_t tick);

 private:
  /// The state for those who enter; one for all at a time.
  struct EntryState {
    std::vector<std::byte> bytes;
    std::size_t size = 0;
    std::uint64_t ticks = 0;
    std::uint64_t hash = 0;
    bool ready = false;
  };
  /// Relay: the state on its way from a donor.
  struct Donation {
    DumpTransfer transfer;
    bool under_way = false;
    std::int64_t since_us = 0;
    unsigned next_donor = 0;
  };

  [[nodiscard]] bool is_in_use() const;
  void capture();
  [[nodiscard]] bool is_silent(const Seat& seat) const;
  void ask_donor();
  [[nodiscard]] ByteView bytes_of(const Follower& follower) const;

  ServerData& data_;
  DumpRequests& dumps_;
  const DesyncCases& cases_;
  EntryState entry_;
  Donation donation_;
  KeyframeStore keyframes_;
  std::int64_t pieces_until_us_ = 0;  ///< the time that the pieces sent so far take
};

}  // namespace lockstone::net
