#include "tools/simnet/match.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <lockstone/net/server.h>
#include <lockstone/net/transport_sim.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

#include "net/transport/random.h"
#include "tools/simnet/node.h"
#include "tools/simnet/oracle.h"

namespace lockstone::simnet {
namespace {

using net::Random;

constexpr std::int64_t k_step_us = 4'000;
constexpr std::int64_t k_patience_us = 30'000'000;
constexpr std::int64_t k_base_delay_us = 5'000;
constexpr std::size_t k_bytes_in_flight_max = 32U << 20;
constexpr std::int64_t k_reorder_us = 100'000;

/// A disk that stores all bytes it is given, until it is full.
class LimitedSink final : public replay::Sink {
 public:
  Status append(ByteView bytes) override { return full ? Status::io_error : memory.append(bytes); }
  replay::MemorySink memory;
  bool full = false;
};

void add_to(net::LinkFaults& faults, const FaultEvent& event) {
  switch (event.kind) {
    case FaultKind::loss:
      faults.loss_ppm = event.amount;
      break;
    case FaultKind::burst:
      faults.burst_start_ppm = event.amount;
      break;
    case FaultKind::duplicate:
      faults.duplicate_ppm = event.amount;
      break;
    case FaultKind::reorder:
      faults.reorder_ppm = event.amount;
      faults.reorder_us = k_reorder_us;
      break;
    case FaultKind::delay:
      faults.delay_us = std::int64_t{event.amount} * 1000;
      break;
    case FaultKind::jitter:
      faults.jitter_us = std::int64_t{event.amount} * 1000;
      break;
    case FaultKind::corrupt:
      faults.corrupt_ppm = event.amount;
      break;
    case FaultKind::truncate:
      faults.truncate_ppm = event.amount;
      break;
    default:
      break;
  }
}

class SimMatch final : public net::ServerObserver {
 public:
  SimMatch(const Game& game, const MatchSetup& setup);
  MatchOutcome run();

 private:
  [[nodiscard]] net::ServerConfig server_config() const;
  void start_node(std::size_t index);
  void note_connection(std::size_t index);
  [[nodiscard]] bool is_liar(std::size_t index) const {
    return setup_.lie != Lie::none && index + 1 == setup_.clients;
  }
  void start_spectator(std::size_t index);
  void start_late();
  [[nodiscard]] std::int64_t kill_until_us(std::size_t client) const;
  [[nodiscard]] bool must_ask_again(std::size_t client) const;
  void revive();
  [[nodiscard]] net::ClientConfig client_config(std::size_t index) const;
  [[nodiscard]] net::LinkFaults faults_of(std::size_t client) const;
  void step();
  void begin_faults();
  void change_faults();
  void set_event(const FaultEvent& event, bool active);
  void forge();
  [[nodiscard]] bool over() const;
  void check_end();
  [[nodiscard]] bool came_too_late(std::size_t client) const;
  void check_log();
  void check_control();
  [[nodiscard]] MatchOutcome outcome() const;

  void tick_closed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                   std::optional<std::uint64_t> hash) override;
  void match_started() override { begin_faults(); }
  void match_finished(net::FinishReason, std::uint64_t, std::optional<std::uint64_t>) override {
    oracle_.set_over();
    over_us_ = now_us_;
  }
  void player_left(std::uint8_t slot, net::LeaveReason reason) override;
  void desync_found(const net::DesyncReport& report) override;

  const Game& game_;
  const MatchSetup& setup_;
  MatchMode mode_;
  std::uint64_t key_;
  Random forgery_;
  net::SimNetwork network_;
  net::SimTransport& endpoint_;
  SealedTransport sealed_;
  Oracle oracle_;
  std::unique_ptr<Simulation> simulation_;
  LimitedSink disk_;
  replay::Recorder recorder_;
  std::unique_ptr<net::Server> server_;
  std::vector<Node> nodes_;
  std::vector<net::ConnectionId> connections_;  ///< the server's, by client
  std::vector<std::int64_t> connected_us_;      ///< when last, by client
  net::ConnectionId connections_made_ = 0;
  std::vector<bool> active_;  ///< by event
  std::vector<net::DesyncReport> reports_;
  std::int64_t now_us_ = 0;
  std::int64_t started_us_ = -1;
  std::int64_t over_us_ = -1;
  std::uint64_t kills_ = 0;
  std::uint64_t too_late_ = 0;
};

SimMatch::SimMatch(const Game& game, const MatchSetup& setup)
    : game_(game),
      setup_(setup),
      mode_(draw_mode(setup.seed, setup.clients,
                      heal_ms(setup.ticks, game.factory(game.config).value()->info().tick_rate))),
      key_(Random(setup.seed ^ 0x5ea1ed).next()),
      forgery_(setup.seed ^ 0xf0e6e),
      network_(setup.seed),
      endpoint_(network_.add_endpoint()),
      sealed_(endpoint_, key_),
      oracle_(game.factory(game.config).value(), setup.ticks),
      simulation_(game.factory(game.config).value()),
      recorder_(disk_,
                {.keyframe_bytes_max = simulation_->snapshot_bytes_max(SnapshotKind::canonical)}),
      active_(setup.schedule.size()) {
  net::ServerParts parts;
  parts.transport = &sealed_;
  parts.simulation = mode_.authoritative ? simulation_.get() : nullptr;
  parts.describer = simulation_.get();
  parts.observer = this;
  server_ = std::move(net::Server::create(server_config(), parts).server);
  if (mode_.authoritative) {
    const Status begun = recorder_.begin(simulation_->info(), game.config, {.seed = setup.seed});
    if (begun != Status::ok) oracle_.fail("the log does not begin");
  }
  if (setup.control) oracle_.excuse(setup.control->client, setup.control->tick);
  connections_.resize(setup.clients + mode_.spectators);
  connected_us_.resize(connections_.size());
  nodes_.reserve(connections_.size());
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    nodes_.emplace_back(i, setup.seed, simulation_->info().input_bytes, oracle_);
    if (i >= setup.clients) start_spectator(i);
    if (i < setup.clients - mode_.late_clients) start_node(i);
  }
}

net::ServerConfig SimMatch::server_config() const {
  net::ServerConfig config;
  config.insecure = true;
  config.match_config = game_.config;
  config.info = simulation_->info();
  config.tick_count = setup_.ticks;
  config.input_delay_ticks = mode_.input_delay_ticks;
  config.late_policy = mode_.late_policy;
  config.pacing = mode_.pacing;
  config.timeouts.handshake_us = k_patience_us;
  config.start_players = static_cast<std::uint8_t>(setup_.clients - mode_.late_clients);
  config.desync_policy = setup_.policy;
  config.rejoin_seed = setup_.seed;
  config.max_spectators = 2;
  config.spectator_delay_ticks = mode_.spectator_delay_ticks;
  return config;
}

void SimMatch::start_node(std::size_t index) {
  const bool faulty = setup_.control && setup_.control->client == index;
  nodes_[index].start(network_, endpoint_, key_, faults_of(index), client_config(index),
                      faulty ? game_.faulty_factory : game_.factory,
                      is_liar(index) ? setup_.lie : Lie::none);
  note_connection(index);
}

void SimMatch::note_connection(std::size_t index) {
  connections_[index] = ++connections_made_;
  connected_us_[index] = now_us_;
}

net::ClientConfig SimMatch::client_config(std::size_t index) const {
  net::ClientConfig config;
  config.insecure = true;
  config.wanted_slot = static_cast<std::uint8_t>(index);
  config.timeouts.handshake_us = k_patience_us;
  if (index % 2 == 0) {
    config.prediction_ticks = mode_.prediction_ticks;
    config.sync_test = mode_.sync_test;
  }
  return config;
}

void SimMatch::start_spectator(std::size_t index) {
  net::ClientConfig config = client_config(index);
  config.wanted_slot = net::k_spectator_slot;
  nodes_[index].watch_only(mode_.spectator_delay_ticks);
  nodes_[index].start(network_, endpoint_, key_, faults_of(index), config, game_.factory);
  note_connection(index);
}

net::LinkFaults SimMatch::faults_of(std::size_t client) const {
  net::LinkFaults faults;
  faults.delay_us = k_base_delay_us;
  for (std::size_t i = 0; i < setup_.schedule.size(); ++i) {
    if (active_[i] && setup_.schedule[i].client == client) add_to(faults, setup_.schedule[i]);
  }
  return faults;
}

// Clients that come when the match runs already.
void SimMatch::start_late() {
  if (started_us_ < 0 || now_us_ < started_us_ + std::int64_t{mode_.late_ms} * 1000) return;
  for (std::size_t i = setup_.clients - mode_.late_clients; i < setup_.clients; ++i) {
    const bool dead = kill_until_us(i) > now_us_;
    if (!nodes_[i].alive() && !dead && !oracle_.over()) start_node(i);
  }
}

// A client that died before it heard of its key finds its seat taken, until the server misses it.
bool SimMatch::must_ask_again(std::size_t client) const {
  constexpr std::int64_t k_pause_us = 1'000'000;
  const net::Client& one = nodes_[client].client();
  return one.state() == net::ClientState::refused && client < setup_.clients && !oracle_.over() &&
         one.refusal().reason == net::RefuseReason::slot_taken &&
         now_us_ - connected_us_[client] > k_pause_us;
}

// A client that has lost its connection asks for a new one.
void SimMatch::revive() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    const bool sent_away = is_liar(i) && node.alive() && !node.client().may_reconnect();
    if (!node.alive() || sent_away) continue;
    if (must_ask_again(i)) {
      node.kill(network_);
      start_node(i);
    }
    if (node.client().state() != net::ClientState::failed) continue;
    if (node.client().failure() == net::ClientFailure::not_deterministic) {
      return oracle_.fail(fmt::format("client {} is not deterministic", i));
    }
    if (oracle_.over()) continue;
    node.reconnect(network_, endpoint_, faults_of(i));
    note_connection(i);
  }
}

// The last moment of a death that is under way; 0: none is.
std::int64_t SimMatch::kill_until_us(std::size_t client) const {
  std::int64_t until_us = 0;
  for (std::size_t i = 0; i < setup_.schedule.size(); ++i) {
    const FaultEvent& event = setup_.schedule[i];
    if (!active_[i] || event.kind != FaultKind::kill || event.client != client) continue;
    until_us = started_us_ + std::int64_t{event.until_ms} * 1000;
  }
  return until_us;
}

void SimMatch::begin_faults() {
  started_us_ = now_us_;
}

void SimMatch::change_faults() {
  if (started_us_ < 0) return;
  const std::int64_t at_ms = (now_us_ - started_us_) / 1000;
  bool links_changed = false;
  for (std::size_t i = 0; i < setup_.schedule.size(); ++i) {
    const FaultEvent& event = setup_.schedule[i];
    const bool active = at_ms >= event.from_ms && at_ms < event.until_ms;
    if (active == active_[i]) continue;
    active_[i] = active;
    links_changed = true;
    set_event(event, active);
  }
  if (!links_changed) return;
  for (std::size_t client = 0; client < nodes_.size(); ++client) {
    if (nodes_[client].alive()) network_.set_faults(nodes_[client].endpoint(), faults_of(client));
  }
}

void SimMatch::set_event(const FaultEvent& event, bool active) {
  if (event.client >= nodes_.size()) return;
  Node& node = nodes_[event.client];
  const std::int64_t until_us = started_us_ + std::int64_t{event.until_ms} * 1000;
  switch (event.kind) {
    case FaultKind::cut:
      if (active && node.alive()) network_.partition(node.endpoint(), now_us_, until_us);
      break;
    case FaultKind::cut_sending:
      if (active && node.alive()) {
        network_.partition(node.endpoint(), now_us_, until_us, net::Cut::sending);
      }
      break;
    case FaultKind::cut_hearing:
      if (active && node.alive()) {
        network_.partition(node.endpoint(), now_us_, until_us, net::Cut::receiving);
      }
      break;
    case FaultKind::pause:
      node.set_paused(active);
      break;
    case FaultKind::kill:
      if (active && node.alive()) {
        node.kill(network_);
        ++kills_;
      }
      if (!active && !node.alive() && !oracle_.over()) start_node(event.client);
      break;
    case FaultKind::skew:
      node.set_skew(active ? std::int64_t{event.amount} - 500 : 0);
      break;
    case FaultKind::disk_full:
      disk_.full = active;
      break;
    default:
      break;
  }
}

// Half of the forgeries look like messages.
void SimMatch::forge() {
  std::array<std::byte, 64> bytes{};
  for (std::size_t i = 0; i < setup_.schedule.size(); ++i) {
    const FaultEvent& event = setup_.schedule[i];
    if (!active_[i] || event.kind != FaultKind::forge || event.client >= nodes_.size()) continue;
    const auto ppm = static_cast<std::uint32_t>(event.amount * k_step_us);
    if (!forgery_.chance(ppm)) continue;
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(forgery_.below(256));
    if (forgery_.chance(500'000)) bytes[0] = static_cast<std::byte>(1 + forgery_.below(14));
    const auto size = static_cast<std::size_t>(1 + forgery_.below(bytes.size()));
    network_.forge(endpoint_, connections_[event.client], ByteView(bytes).first(size));
  }
}

void SimMatch::step() {
  network_.set_time(now_us_);
  change_faults();
  start_late();
  revive();
  forge();
  server_->update(now_us_);
  for (Node& node : nodes_)
    node.update(k_step_us);
  if (network_.traffic().bytes > k_bytes_in_flight_max) oracle_.fail("too much is on its way");
  now_us_ += k_step_us;
}

bool SimMatch::over() const {
  const bool all_done = std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) {
    return !node.alive() || node.client().state() >= net::ClientState::finished;
  });
  return !oracle_.failure().empty() || (all_done && server_->state() == net::ServerState::over);
}

MatchOutcome SimMatch::run() {
  const std::uint16_t rate = simulation_->info().tick_rate;
  const std::int64_t match_us = static_cast<std::int64_t>(setup_.ticks * 1'000'000 / rate);
  const std::int64_t limit_us = 2 * match_us + k_patience_us;
  while (!over() && now_us_ < limit_us)
    step();
  if (oracle_.failure().empty() && setup_.control) check_control();
  if (oracle_.failure().empty() && !setup_.control) check_end();
  if (oracle_.failure().empty() && mode_.authoritative) check_log();
  return outcome();
}

void SimMatch::check_end() {
  if (server_->state() != net::ServerState::over) {
    return oracle_.fail(fmt::format("no progress: {} of {} ticks after {} ms",
                                    server_->ticks_closed(), setup_.ticks, now_us_ / 1000));
  }
  if (server_->finish_reason() != net::FinishReason::completed && kills_ < nodes_.size()) {
    oracle_.fail(fmt::format("the match ended: {}", to_string(server_->finish_reason())));
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_liar(i)) continue;
    if (!nodes_[i].alive() || nodes_[i].client().ticks_stepped() == setup_.ticks) continue;
    if (came_too_late(i)) {
      ++too_late_;
      continue;
    }
    oracle_.fail(fmt::format("client {} has {} of {} ticks", i, nodes_[i].client().ticks_stepped(),
                             setup_.ticks));
  }
}

// The faults heal early enough before the end by the tick rate. A fast match is over long before,
// and may be while somebody is still on the way in. A client that had the time that it has in other
// matches after the last fault must be in.
bool SimMatch::came_too_late(std::size_t client) const {
  if (mode_.pacing != net::Pacing::fast || over_us_ < 0) return false;
  const std::uint16_t rate = simulation_->info().tick_rate;
  const std::int64_t match_ms = static_cast<std::int64_t>(setup_.ticks * 1000 / rate);
  const std::int64_t healed_ms = match_ms - heal_ms(setup_.ticks, rate);
  return !nodes_[client].client().active_tick() &&
         over_us_ - connected_us_[client] < healed_ms * 1000;
}

void SimMatch::check_control() {
  const Control& control = *setup_.control;
  if (reports_.size() != 1) {
    return oracle_.fail(fmt::format("{} reports instead of one", reports_.size()));
  }
  const net::DesyncReport& report = reports_[0];
  const bool right = report.tick == control.tick && report.difference.store == control.store &&
                     report.difference.object == control.object &&
                     report.difference.field == control.field;
  if (!right) oracle_.fail("the report names something else: " + report.to_line());
}

// The part written before the disk was full, or until the end, is a good log.
void SimMatch::check_log() {
  replay::MemorySource source(disk_.memory.bytes());
  const replay::VerifyReport report = replay::verify(source, game_.factory);
  if (report.outcome != replay::VerifyOutcome::same) {
    oracle_.fail("the log is not good: " + report.to_line());
  }
}

MatchOutcome SimMatch::outcome() const {
  MatchOutcome outcome;
  outcome.failure = oracle_.failure();
  outcome.mode = mode_;
  outcome.ticks = server_->ticks_closed();
  outcome.comparisons = oracle_.comparisons();
  outcome.last_hash = oracle_.last_hash();
  outcome.refused_packets = sealed_.refused();
  outcome.kills = kills_;
  outcome.too_late = too_late_;
  outcome.virtual_ms = static_cast<std::uint64_t>(now_us_ / 1000);
  outcome.peak_bytes = network_.traffic().peak_bytes;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    outcome.client_ticks += nodes_[i].ticks();
    outcome.resends += nodes_[i].resends();
    outcome.refused_packets += nodes_[i].refused_packets();
    outcome.rollbacks += nodes_[i].rollbacks();
    if (i >= setup_.clients) continue;
    const net::PlayerStats stats = server_->stats(static_cast<std::uint8_t>(i));
    outcome.substituted_inputs += stats.substituted_inputs;
    outcome.entries += stats.entries;
  }
  return outcome;
}

void SimMatch::tick_closed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                           std::optional<std::uint64_t> hash) {
  oracle_.closed(tick, inputs, hash);
  if (!hash || recorder_.record_tick(tick, inputs, *hash) != Status::ok) return;
  if (recorder_.keyframe_due()) static_cast<void>(recorder_.keyframe(*simulation_));
}

void SimMatch::player_left(std::uint8_t slot, net::LeaveReason reason) {
  const bool expected = is_liar(slot) || reason == net::LeaveReason::left ||
                        reason == net::LeaveReason::match_over ||
                        reason == net::LeaveReason::disconnected || !nodes_[slot].alive() ||
                        nodes_[slot].client().state() < net::ClientState::lobby;
  if (!expected) {
    oracle_.fail(fmt::format("tick {}: client {} was lost: {}", server_->ticks_closed(), slot,
                             to_string(reason)));
  }
}

void SimMatch::desync_found(const net::DesyncReport& report) {
  reports_.push_back(report);
  reports_.back().dump_here = {};
  reports_.back().dump_there = {};
  if (!setup_.control && !is_liar(report.slot)) oracle_.fail("unexplained: " + report.to_line());
}

}  // namespace

MatchOutcome run_match(const Game& game, const MatchSetup& setup) {
  return SimMatch(game, setup).run();
}

}  // namespace lockstone::simnet
