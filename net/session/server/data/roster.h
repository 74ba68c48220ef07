// Who takes part in a match: the seats of its players and the places of its spectators.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/net/wire.h>

#include "net/security/rate_limit.h"
#include "net/session/command_buffer.h"
#include "net/session/server/data/peers.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

/// No tick: a player with this `active_tick` does not play yet.
inline constexpr std::uint64_t k_never = std::numeric_limits<std::uint64_t>::max();

/// How far a follower has been sent the commands of ticks.
struct CommandCursor {
  bool found = false;      ///< its place among the match's commands is known
  std::uint64_t next = 0;  ///< the command that is being sent
  std::size_t sent = 0;    ///< bytes of it
};

/// The commands of a seat's player on their way to a tick.
struct SeatCommands {
  CommandBuffer waiting;
  std::uint64_t taken = 0;        ///< came whole, or were refused, since the seat was made
  std::size_t refused_bytes = 0;  ///< still to come of a command that is refused
  RateLimit rate;
  RateLimit bytes_rate;
};

/// Somebody to whom confirmed ticks go: a player, or a spectator.
struct Follower {
  Peer* peer = nullptr;              ///< null: nobody is here (any more)
  std::uint64_t ticks_received = 0;  ///< confirmed ticks below are at the client
  std::uint64_t cursor = 0;          ///< where the next Ticks goes on, if not all fit
  std::uint64_t last_sent_confirmed = 0;
  std::int64_t last_sent_us = 0;
  std::uint64_t resend_next = 0;  ///< resend_next … resend_end - 1 were asked for
  std::uint64_t resend_end = 0;
  bool loading = false;            ///< waits for a state to begin from; gets no ticks
  bool offered = false;            ///< and is being sent the one after `ticks_received` ticks
  bool keyframed = false;          ///< which is a keyframe, not the entry state
  std::uint64_t oldest_entry = 0;  ///< a state of fewer ticks does not help it
  std::size_t snapshot_sent = 0;
  unsigned bad_snapshots = 0;
  CommandCursor commands;

  /// From now on it waits for a state after `oldest_ticks` ticks or more.
  void await_state(std::uint64_t oldest_ticks);

  /// It is sent the state after `ticks` ticks, from its first byte on.
  void begin_snapshot(std::uint64_t ticks, bool is_keyframe);

  /// It has a state, or is being sent one, and so needs every tick from there on.
  [[nodiscard]] bool needs_ticks() const { return peer != nullptr && (!loading || offered); }
};

/// A slot of the match, whether its player is here or not.
struct Seat : Follower {
  TickRing inputs;
  std::uint64_t inputs_next = 0;        ///< inputs below are received or replaced
  std::uint64_t active_tick = k_never;  ///< its player plays from this tick on
  PeerIdentity identity;                ///< of its player, here or lost
  std::uint64_t rejoin_key = 0;         ///< who has it may sit here again
  std::int64_t reserved_until_us = -1;  ///< so long nobody else may, if it is empty
  std::int8_t margin = k_no_margin;     ///< the least since it was last told
  std::size_t dump_bytes_allowed = 0;   ///< of dumps that it was asked for and that may still come
  std::uint64_t hashes_had = 0;         ///< hashes below were here …
  std::int64_t hashes_since_us = 0;     ///< … since then, and others are owed
  std::uint64_t hashes_since_tick = 0;  ///< and it had the ticks below this one
  bool condemned = false;  ///< its state was wrong: it is out until its case is settled
  bool expelled = false;   ///< and for good
  bool confirmed = false;  ///< its player has spoken since it was told its key
  PlayerStats stats;
  SeatCommands own_commands;
  PlayerName name;  ///< of the player that sits here, or sat here last

  /// Its player is here and has a say in tick `tick`.
  [[nodiscard]] bool plays(std::uint64_t tick) const {
    return peer != nullptr && active_tick <= tick;
  }
  /// A new player, or the old one again, sits down.
  void occupy(Peer& player, std::int64_t now_us);
};

/// A spectator's place.
struct Watcher : Follower {
  bool finish_sent = false;
};

/// The seats by slot, and the spectators' places. Neither grows after it is made.
class Roster {
 public:
  Roster(const SimulationInfo& info, const ServerConfig& config);

  [[nodiscard]] std::vector<Seat>& seats() { return seats_; }
  [[nodiscard]] const std::vector<Seat>& seats() const { return seats_; }
  [[nodiscard]] std::vector<Watcher>& watchers() { return watchers_; }
  [[nodiscard]] const std::vector<Watcher>& watchers() const { return watchers_; }

  [[nodiscard]] Seat& seat(std::uint8_t slot) { return seats_[slot]; }
  [[nodiscard]] const Seat& seat(std::uint8_t slot) const { return seats_[slot]; }
  [[nodiscard]] bool is_slot(std::uint8_t slot) const { return slot < seats_.size(); }

  /// Bit n: slot n has a player here.
  [[nodiscard]] SlotMask present_mask() const;

  /// Bit n: slot n's player is here and has a say, now or from a tick that is announced.
  [[nodiscard]] SlotMask active_mask() const;

  /// The follower that a peer is; null for one that is still in the handshake.
  [[nodiscard]] Follower* follower_of(const Peer& peer);

  /// A free spectator's place, or null.
  [[nodiscard]] Watcher* free_watcher();

  /// How many spectators are here.
  [[nodiscard]] std::size_t watching() const;

  /// The peer is gone: its seat or place is empty.
  void forget(const Peer& peer);

 private:
  std::vector<Seat> seats_;
  std::vector<Watcher> watchers_;
};

}  // namespace lockstone::net
