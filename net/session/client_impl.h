// The inside of net::Client, spread over client*.cpp by theme.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/wire.h>

#include "net/session/lead_control.h"
#include "net/session/peer_watch.h"
#include "net/session/playout_clock.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

struct Client::Impl {
  static constexpr std::uint64_t k_never = ~std::uint64_t{0};
  Impl(const ClientConfig& client_config, ClientParts client_parts);

  // client.cpp: the connection, the handshake, the end.
  void update(std::int64_t now);
  void receive();
  void receive_packet(ByteView packet);
  [[nodiscard]] bool dispatch(ByteView packet);
  void watch_server();
  void say_hello();
  [[nodiscard]] bool on_offer(ByteView packet);
  [[nodiscard]] bool on_welcome(ByteView packet);
  [[nodiscard]] bool on_refuse(ByteView packet);
  [[nodiscard]] bool on_start(ByteView packet);
  [[nodiscard]] bool on_desync(ByteView packet);
  [[nodiscard]] bool on_finish(ByteView packet);
  [[nodiscard]] bool on_bye(ByteView packet);
  void connection_ended(RefuseReason reason);
  void reserve_memory();
  void fail(ClientFailure why);
  void hang_up(ClientState final_state, LeaveReason reason);
  [[nodiscard]] bool active() const { return state < ClientState::finished; }
  [[nodiscard]] ClientStats current_stats() const;

  // client_entry.cpp: entering a match that runs, pausing, requests.
  [[nodiscard]] bool reconnect(ConnectionId connection);
  [[nodiscard]] bool knows_state(ByteView offered_config) const;
  void begin_running(std::uint64_t ticks);
  [[nodiscard]] bool on_snapshot(ByteView packet);
  void take_snapshot(const Snapshot& last_piece);
  [[nodiscard]] bool on_activate(ByteView packet);
  [[nodiscard]] bool on_paused(ByteView packet);
  [[nodiscard]] bool spectates() const { return seat.slot == k_spectator_slot; }

  // client_predict.cpp: rollback.
  [[nodiscard]] bool predicts() const { return config.prediction_ticks > 0 && !spectates(); }
  void keep_state();
  void confirm_one();
  [[nodiscard]] bool guessed_right() const;
  void roll_back(std::uint64_t tick);
  [[nodiscard]] bool may_reconnect() const;
  void predict_ticks();
  void predict_one();
  void guess_slot(std::span<std::byte> record, std::uint8_t slot);
  [[nodiscard]] std::uint64_t step_record(ByteView record);
  void test_sync();

  // client_play.cpp: ticks in, inputs and hashes out.
  [[nodiscard]] bool on_ticks(ByteView packet);
  [[nodiscard]] bool on_dump_request(ByteView packet);
  void take_records(const Ticks& message);
  void step_ticks(std::uint64_t unacknowledged_limit);
  void step_one();
  void step_rest();
  void after_step(std::uint64_t hash);
  void note_parts();
  [[nodiscard]] bool due(std::uint64_t tick) const;
  void sample_inputs();
  [[nodiscard]] std::uint64_t sample_target();
  void request_missing();
  void send_due_inputs();
  void send_inputs(std::uint64_t first_hash_tick);
  [[nodiscard]] std::size_t dump_kept_state(std::uint64_t ticks);
  void send_dump_chunks();
  [[nodiscard]] std::uint64_t unacknowledged_limit() const;

  template <class Message>
  void send(const Message& message, Channel channel = Channel::reliable) {
    const std::size_t size = encode(message, out);
    // A full queue shows as silence, and silence as a time-out.
    static_cast<void>(parts.transport->send(parts.connection, channel, ByteView(out).first(size)));
  }

  ClientConfig config;
  ClientParts parts;
  ClientObserver silent_observer;
  ClientObserver* observer;

  ClientState state = ClientState::connecting;
  ClientFailure failure = ClientFailure::none;
  LeaveReason leave_reason = LeaveReason::left;
  FinishReason finish_reason = FinishReason::completed;
  Refusal refusal;
  PeerWatch watch;
  ClientStats stats;
  bool updated = false;  ///< before, there is no time to count from
  std::int64_t now_us = 0;
  std::int64_t begun_us = 0;  ///< first update

  std::unique_ptr<Simulation> simulation;
  SimulationInfo info;
  TickShape shape;
  std::int64_t tick_us = 0;
  Welcome seat;
  bool seated = false;

  TickRing records;              ///< closed ticks
  std::uint64_t stepped = 0;     ///< ticks below are stepped
  std::uint64_t state_hash = 0;  ///< of the state after them; 0 at first
  std::uint64_t received = 0;    ///< ticks below are here
  std::uint64_t rejoin_key = 0;
  std::uint64_t offered_hash = 0;  ///< of the configuration that `simulation` was made from
  bool over = false;               ///< the match is: nothing is kept back
  bool offered = false;            ///< the configuration came over this connection
  std::uint64_t sync_tested = 0;
  bool paused = false;
  std::uint64_t active_tick = k_never;  ///< own inputs count from here on
  std::vector<std::byte> entry;         ///< a snapshot that comes in pieces
  std::size_t entry_received = 0;
  std::uint64_t entry_ticks = 0;
  PlayoutClock playout;
  LeadControl lead;

  std::uint64_t head = 0;  ///< predicting: the simulation stands here, at or after `stepped`
  TickRing states;         ///< native snapshots, by the ticks stepped before
  TickRing guesses;        ///< the records stepped
  std::vector<std::uint64_t> guess_hashes;
  std::vector<std::byte> scratch;

  std::uint64_t received_end = 0;  ///< no tick from here on has come
  std::uint64_t gap_tick = 0;      ///< `received` when a gap was last looked for
  std::int64_t gap_since_us = 0;
  std::int64_t last_resend_us = 0;
  std::uint16_t waiting = 0;
  std::uint16_t present_mask = 0;  ///< at the start

  TickRing own_inputs;
  std::uint64_t sampled = 0;         ///< own inputs below are sampled
  std::uint64_t inputs_acked = 0;    ///< own inputs below need not be sent
  std::int64_t clock_us = 0;         ///< the time of the trimmed local clock, from any origin
  std::int64_t clock_set_us = 0;     ///< when it was last moved on
  std::int64_t clock_origin_us = 0;  ///< at this time by it …
  std::uint64_t clock_tick = 0;      ///< … this tick began

  HashRing hashes;
  std::uint64_t hashes_acked = 0;
  Parts state_parts;  ///< of the newest state that has some; predicting, it may be a guess
  TickRing snapshots;
  std::vector<std::byte> dump;  ///< snapshot_bytes_max
  std::size_t dump_size = 0;
  std::size_t dump_sent = 0;
  std::uint64_t dump_tick = 0;

  std::int64_t last_sent_us = 0;
  bool news = false;  ///< something to say since the last Inputs

  std::vector<std::byte> out;  ///< a message being encoded
  std::array<std::byte, k_max_datagram_bytes> coded{};
};

}  // namespace lockstone::net
