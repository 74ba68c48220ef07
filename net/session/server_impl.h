// The inside of net::Server, spread over server_*.cpp by theme.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/net/wire.h>

#include "net/session/hash_judge.h"
#include "net/session/offender_list.h"
#include "net/session/parts_judge.h"
#include "net/session/peer_watch.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

/// How far apart the states are that a delayed spectator may begin from.
[[nodiscard]] inline std::uint32_t keyframe_ticks_of(const ServerConfig& config) {
  return std::max<std::uint32_t>(60, config.spectator_delay_ticks / 8);
}

/// A canonical snapshot on its way from a player.
struct DumpTransfer {
  std::uint8_t slot = k_no_slot;  ///< who sends it; k_no_slot: the server's own
  std::vector<std::byte> bytes;   ///< grows as they come, whatever length was claimed
  std::size_t total_bytes = 0;    ///< as claimed by the first piece
  bool done = false;              ///< arrived whole, or will not come: then `bytes` is empty
  std::int64_t asked_us = -1;     ///< when it was asked for; below 0: not yet
};

/// A mismatch whose snapshots are being fetched.
struct DesyncCase {
  Mismatch mismatch;
  bool ends_match = false;  ///< then no tick closes any more
  std::string part;         ///< if the 128-bit hashes found it
  DumpTransfer here;
  DumpTransfer there;
};

struct Server::Impl {
  static constexpr std::uint64_t k_never = ~std::uint64_t{0};
  enum class Stage : std::uint8_t { unused, connected, offered, seated, watching };

  struct Link {
    ConnectionId connection = k_no_connection;
    Stage stage = Stage::unused;
    std::uint8_t slot = k_no_slot;  ///< of a seated one
    std::uint8_t wanted_slot = k_any_slot;
    PeerIdentity identity;
    std::uint64_t rejoin_key = 0;
    std::uint64_t ticks_stepped = 0;
    std::uint64_t state_hash = 0;
    BuildText build;
    std::int64_t since_us = 0;
    PeerWatch watch;
    NameText name;
  };

  /// Somebody to whom closed ticks go: a player, or a spectator.
  struct Follower {
    Link* link = nullptr;              ///< null: nobody is here (any more)
    std::uint64_t ticks_received = 0;  ///< closed ticks below are at the client
    std::uint64_t cursor = 0;          ///< where the next Ticks goes on, if not all fit
    std::uint64_t last_sent_closed = 0;
    std::int64_t last_sent_us = 0;
    std::uint64_t resend_next = 0;  ///< resend_next … resend_end - 1 were asked for
    std::uint64_t resend_end = 0;
    bool loading = false;            ///< waits for a state to begin from; gets no ticks
    bool offered = false;            ///< and is being sent the one after `ticks_received` ticks
    bool keyframed = false;          ///< out of `keyframes`, not `entry`
    std::uint64_t oldest_entry = 0;  ///< a state of fewer ticks does not help it
    std::size_t snapshot_sent = 0;
    unsigned bad_snapshots = 0;
  };

  struct Seat : Follower {
    TickRing inputs;
    std::uint64_t inputs_next = 0;        ///< inputs below are received or replaced
    std::uint64_t active_tick = k_never;  ///< its player plays from this tick on
    PeerIdentity identity;                ///< of its player, here or lost
    std::uint64_t rejoin_key = 0;         ///< who has it may sit here again
    std::int64_t reserved_until_us = -1;  ///< so long nobody else may, if it is empty
    std::int8_t margin = k_no_margin;     ///< the least since it was last told
    std::size_t dump_room_bytes = 0;   ///< of dumps that it was asked for and that may still come
    std::uint64_t hashes_had = 0;      ///< hashes below were here …
    std::int64_t hashes_since_us = 0;  ///< … since then, and others are owed
    bool condemned = false;            ///< its state was wrong: it is out until its case is closed
    bool expelled = false;             ///< and for good
    bool confirmed = false;            ///< its player has spoken since it was told its key
    PlayerStats stats;
  };
  struct Watcher : Follower {
    bool finish_sent = false;
  };

  /// A state for those who enter while the match runs; one for all at a time.
  struct EntryState {
    std::vector<std::byte> bytes;
    std::size_t size = 0;
    std::uint64_t ticks = 0;
    std::uint64_t hash = 0;
    bool ready = false;
    DumpTransfer transfer;  ///< relay: from a donor, while `fetching`
    bool fetching = false;
    std::int64_t since_us = 0;
    unsigned next_donor = 0;
  };

  Impl(const ServerConfig& server_config, const ServerParts& server_parts);

  // server.cpp: connections, time, the end.
  void update(std::int64_t now);
  void receive();
  void receive_packet(Link& link, const TransportEvent& event);
  [[nodiscard]] bool dispatch(Link& link, ByteView packet);
  void watch_peers();
  void resume();
  [[nodiscard]] bool awaits_players();
  void release(Link& link);
  void drop(Link& link, LeaveReason reason);
  void seat_lost(std::uint8_t slot, LeaveReason reason);
  void expel(std::uint8_t slot, LeaveReason reason);
  void end_if_deserted();
  void begin_finishing();
  void try_finish();
  void finish(FinishReason reason);
  void try_end();
  [[nodiscard]] Link* find_link(ConnectionId connection);
  [[nodiscard]] std::uint16_t present_mask() const;
  [[nodiscard]] PlayerStats stats_of(std::uint8_t slot) const;
  [[nodiscard]] ConnectionCounts connections() const;
  [[nodiscard]] std::optional<std::uint64_t> final_hash() const;

  // server_handshake.cpp
  void accept(ConnectionId connection);
  [[nodiscard]] bool on_hello(Link& link, ByteView packet);
  [[nodiscard]] bool on_answer(Link& link, ByteView packet);
  [[nodiscard]] bool refuse_secure_hello(Link& link, ByteView packet);
  [[nodiscard]] Refusal judge_hello(const Link& link, const Hello& hello) const;
  [[nodiscard]] Refusal judge_seats(const Link& link) const;
  [[nodiscard]] bool is_barred(const Link& link) const;
  [[nodiscard]] Refusal judge_info(const SimulationInfo& theirs) const;
  void refuse(Link& link, const Refusal& refusal);
  void seat(Link& link, std::uint8_t slot);
  [[nodiscard]] std::uint8_t free_slot(const Link& link) const;
  [[nodiscard]] std::uint8_t wanted_slot(const Link& link) const;
  [[nodiscard]] bool is_player_of(const Link& link, const Seat& place) const;
  [[nodiscard]] Welcome welcome(std::uint8_t slot, Entry way) const;
  void try_start();

  // server_entry.cpp: entering a match that runs.
  void enter(std::uint8_t slot, const Link& link);
  [[nodiscard]] bool may_go_on(const Link& link) const;
  void resync(std::uint8_t slot);
  void load_anew(Follower& follower, std::uint64_t oldest_ticks);
  void advance_entries();
  void offer_entry(Follower& follower, std::uint8_t slot);
  void capture_entry();
  void fetch_entry();
  void take_fetched_entry();
  [[nodiscard]] bool entry_in_use() const;
  [[nodiscard]] ByteView entry_bytes(const Follower& follower) const;
  void send_entry_chunks(Follower& follower);
  [[nodiscard]] bool on_snapshot_taken(Link& link, ByteView packet);
  void try_activate(std::uint8_t slot);
  void set_paused(bool pause);
  [[nodiscard]] bool on_ask(const Link& link, ByteView packet);
  [[nodiscard]] Follower* follower_of(const Link& link);

  // server_spectators.cpp
  [[nodiscard]] Refusal judge_spectator() const;
  void welcome_spectator(Link& link);
  [[nodiscard]] std::uint64_t visible_ticks() const;
  void keep_keyframe();
  void begin_watching(Watcher& watcher, std::uint64_t has);
  void offer_keyframe(Watcher& watcher);
  void serve_spectators();
  void end_spectators();

  // server_ticks.cpp: inputs in, closed ticks out.
  [[nodiscard]] bool on_inputs(Link& link, ByteView packet);
  [[nodiscard]] bool on_resend(Link& link, ByteView packet);
  [[nodiscard]] bool take_spectators_word(const Link& link, const Inputs& message);
  void take_inputs(Seat& place, const Inputs& message);
  void take_hashes(std::uint8_t slot, const Inputs& message);
  void close_due_ticks();
  [[nodiscard]] bool may_close_next();
  void close_tick();
  void fill_slot(std::span<std::byte> record, std::uint8_t slot);
  [[nodiscard]] std::optional<std::uint64_t> step_simulation(ByteView record);
  [[nodiscard]] std::uint16_t missing_inputs_mask() const;
  [[nodiscard]] std::uint16_t laggards_mask() const;
  void drop_waited_for();
  void drop_laggards();
  void drop_secretive();
  void rebase_schedule(std::int64_t due_us);
  [[nodiscard]] std::int64_t due_us() const;
  void send_due_ticks();
  void note_margin(Seat& place, std::uint64_t tick);
  [[nodiscard]] bool anybody_plays() const;
  [[nodiscard]] bool follows(const Seat& place) const;
  [[nodiscard]] std::uint64_t end_for(const Follower& follower) const;
  [[nodiscard]] bool ticks_due(const Seat& place) const;
  void send_unconfirmed(Follower& follower, Ticks& message);
  std::uint64_t send_ticks(const Follower& follower, std::uint64_t first_tick, Channel channel,
                           Ticks& message);
  void send_resends(Follower& follower, Ticks& message);

  // server_desync.cpp
  void judge_hashes();
  void tell_agreed(const std::optional<Mismatch>& found);
  void judge_parts();
  void note_own_parts();
  [[nodiscard]] bool on_parts(const Link& link, ByteView packet);
  [[nodiscard]] std::string name_of_part(std::size_t part) const;
  void open_case(const Mismatch& mismatch, const std::string& part);
  void condemn(std::uint8_t slot);
  void begin_case();
  [[nodiscard]] bool frozen() const;
  [[nodiscard]] bool dumps(std::uint8_t slot) const;
  [[nodiscard]] bool is_awaited(const DumpTransfer& transfer) const;
  [[nodiscard]] std::size_t dump_limit_bytes() const;
  void request_dump(DumpTransfer& transfer, std::uint8_t slot, std::uint64_t tick);
  [[nodiscard]] bool on_dump(Link& link, ByteView packet);
  [[nodiscard]] bool take_chunk(DumpTransfer& transfer, const Dump& dump) const;
  [[nodiscard]] DumpTransfer* transfer_of(std::uint8_t slot, std::uint64_t tick);
  void advance_cases();
  DesyncCase report_case();
  void close_case();
  [[nodiscard]] std::string build_of(std::uint8_t slot) const;
  [[nodiscard]] bool server_is_wrong(const Mismatch& mismatch);
  [[nodiscard]] DesyncReport report_of(const DesyncCase& found) const;
  void send_notice(const DesyncReport& report);

  template <class Message>
  void send(const Link& link, const Message& message) {
    const std::size_t size = encode(message, out);
    // A full queue shows as silence, and silence as a time-out.
    static_cast<void>(
        parts.transport->send(link.connection, Channel::reliable, ByteView(out).first(size)));
  }

  ServerConfig config;
  ServerParts parts;
  ServerObserver silent_observer;
  ServerObserver* observer;
  SimulationInfo info;
  TickShape shape;
  std::int64_t tick_us;

  ServerState state = ServerState::lobby;
  FinishReason finish_reason = FinishReason::completed;
  std::int64_t now_us = 0;
  std::int64_t state_since_us = 0;

  std::vector<Link> links;  ///< never resized: seats point into it
  std::vector<Seat> seats;
  std::vector<Watcher> watchers;
  EntryState entry;
  TickRing keyframes;  ///< states for delayed spectators, by number of ticks / keyframe_ticks_of()
  std::vector<std::uint64_t> keyframe_hashes;
  std::int64_t chunks_until_us = 0;  ///< the time that the pieces sent so far take
  std::uint64_t keys_given = 0;
  std::uint64_t closed = 0;          ///< ticks 0 … closed - 1 are closed
  std::uint64_t end_tick = 0;        ///< the match has ticks below
  std::uint64_t schedule_tick = 0;   ///< this tick is due …
  std::int64_t schedule_due_us = 0;  ///< … at this time, the others by the tick rate from it
  std::uint16_t waiting = 0;
  std::int64_t waiting_since_us = 0;
  bool paused = false;
  std::uint16_t awaited = 0;           ///< resumed: slots that the match waits for
  std::int64_t first_back_us = -1;     ///< resumed: when the first one could play
  std::int64_t expected_until_us = 0;  ///< resumed: so long somebody may come back
  TickRing records;
  TickRing snapshots;
  HashJudge judge;
  PartsJudge parts_judge;
  std::uint64_t agreed_told = 0;  ///< hash_agreed was called below
  std::vector<DesyncCase> cases;  ///< in the order found; dumps of the first one are fetched
  OffenderList offenders;
  ServerCounters counters;

  std::vector<std::byte> out;  ///< a message being encoded
  std::array<std::byte, k_max_datagram_bytes> coded{};
};

}  // namespace lockstone::net
