#include "tools/simnet/match.h"

#include <algorithm>
#include <memory>
#include <span>

#include <fmt/format.h>

#include <lockstone/net/server.h>
#include <lockstone/net/transport_sim.h>

#include "net/transport/random.h"
#include "tools/simnet/client_group.h"
#include "tools/simnet/fault_plan.h"
#include "tools/simnet/match_log.h"
#include "tools/simnet/oracle.h"
#include "tools/simnet/sealed_transport.h"

namespace lockstone::simnet {
namespace {

using net::Random;

constexpr std::int64_t k_step_us = 4'000;
constexpr std::size_t k_bytes_in_flight_max = 32U << 20;

MatchMode mode_of(const Game& game, const MatchSetup& setup) {
  const std::uint16_t tick_rate = game.factory(game.config).value()->info().tick_rate;
  return draw_mode(setup.seed, setup.clients, heal_ms(setup.ticks, tick_rate));
}

std::uint64_t seal_key(std::uint64_t seed) {
  return Random(seed ^ 0x5ea1ed).next();
}

/// The server of a match, its clients and the network between them, stepped together; checks that
/// all is as it must be.
class SimMatch final : public net::ServerObserver {
 public:
  SimMatch(const Game& game, const MatchSetup& setup);
  MatchOutcome run();

 private:
  [[nodiscard]] net::ServerConfig server_config() const;
  void start_server();
  void step();
  void change_faults();
  [[nodiscard]] bool over() const;
  [[nodiscard]] std::uint64_t check_end();
  [[nodiscard]] bool came_too_late(std::size_t client) const;
  void check_control();
  [[nodiscard]] MatchOutcome outcome() const;

  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override;
  void commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands) override;
  void match_started() override { faults_.begin(now_us_); }
  void match_finished(net::FinishReason, std::uint64_t, std::optional<std::uint64_t>) override {
    oracle_.set_over();
    over_us_ = now_us_;
  }
  void player_left(std::uint8_t slot, net::LeaveReason reason) override;
  void desync_found(const net::DesyncReport& report) override;

  const Game& game_;
  const MatchSetup& setup_;
  MatchMode mode_;
  net::SimNetwork network_;
  net::SimTransport& endpoint_;
  SealedTransport sealed_;
  Oracle oracle_;
  std::unique_ptr<Simulation> simulation_;
  MatchLog log_;
  FaultPlan faults_;
  ClientGroup clients_;
  std::unique_ptr<net::Server> server_;
  std::vector<net::DesyncReport> reports_;
  std::int64_t now_us_ = 0;
  std::int64_t over_us_ = -1;
};

SimMatch::SimMatch(const Game& game, const MatchSetup& setup)
    : game_(game),
      setup_(setup),
      mode_(mode_of(game, setup)),
      network_(setup.seed),
      endpoint_(network_.add_endpoint()),
      sealed_(endpoint_, seal_key(setup.seed)),
      oracle_(game.factory(game.config).value(), setup.ticks),
      simulation_(game.factory(game.config).value()),
      log_(*simulation_),
      faults_(setup.schedule, setup.seed),
      clients_({game, setup, mode_, network_, endpoint_, faults_, oracle_}, seal_key(setup.seed),
               simulation_->info().input_bytes) {
  start_server();
  if (setup.control) oracle_.excuse(setup.control->client, setup.control->tick);
}

void SimMatch::start_server() {
  net::ServerParts parts;
  parts.transport = &sealed_;
  parts.simulation = mode_.authoritative ? simulation_.get() : nullptr;
  parts.describer = simulation_.get();
  parts.observer = this;
  server_ = std::move(net::Server::create(server_config(), parts).server);
  if (!mode_.authoritative) return;
  const Status begun = log_.begin(simulation_->info(), game_, setup_.seed);
  if (begun != Status::ok) oracle_.fail("the log does not begin");
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

void SimMatch::change_faults() {
  const bool changed = faults_.advance(now_us_, [&](const FaultEvent& event, bool active) {
    if (event.kind == FaultKind::disk_full) log_.set_full(active);
    clients_.change_fault(event, active);
  });
  if (changed) clients_.refresh_faults();
}

void SimMatch::step() {
  network_.set_time(now_us_);
  clients_.set_time(now_us_);
  change_faults();
  clients_.advance();
  faults_.forge_packets(k_step_us, clients_.nodes().size(),
                        [&](std::size_t client, ByteView bytes) {
                          network_.forge(endpoint_, clients_.connection(client), bytes);
                        });
  server_->update(now_us_);
  for (Node& node : clients_.nodes())
    node.update(k_step_us);
  if (network_.traffic().bytes > k_bytes_in_flight_max) oracle_.fail("too much is on its way");
  now_us_ += k_step_us;
}

bool SimMatch::over() const {
  const auto& nodes = clients_.nodes();
  const bool all_done = std::all_of(nodes.begin(), nodes.end(), [](const Node& node) {
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
  std::uint64_t too_late = 0;
  if (oracle_.failure().empty() && setup_.control) check_control();
  if (oracle_.failure().empty() && !setup_.control) too_late = check_end();
  if (oracle_.failure().empty() && mode_.authoritative) {
    // The part written before the disk was full, or until the end, is a good log.
    const std::string fault = log_.check(game_);
    if (!fault.empty()) oracle_.fail("the log is not good: " + fault);
  }
  MatchOutcome result = outcome();
  result.too_late = too_late;
  return result;
}

// Returns how many clients were cut off, or on the way in, when a fast match was over.
std::uint64_t SimMatch::check_end() {
  if (server_->state() != net::ServerState::over) {
    oracle_.fail(fmt::format("no progress: {} of {} ticks after {} ms", server_->ticks_confirmed(),
                             setup_.ticks, now_us_ / 1000));
    return 0;
  }
  const auto& nodes = clients_.nodes();
  const bool completed = server_->finish_reason() == net::FinishReason::completed;
  if (!completed && clients_.kills() < nodes.size()) {
    oracle_.fail(fmt::format("the match ended: {}", to_string(server_->finish_reason())));
  }
  std::uint64_t too_late = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (clients_.is_liar(i) || !nodes[i].alive()) continue;
    const std::uint64_t ticks = nodes[i].client().ticks_stepped();
    if (ticks == setup_.ticks) continue;
    if (came_too_late(i)) {
      ++too_late;
    } else {
      oracle_.fail(fmt::format("client {} has {} of {} ticks", i, ticks, setup_.ticks));
    }
  }
  return too_late;
}

// The faults heal early enough before the end by the tick rate. A fast match is over long before,
// and may be while somebody is cut off or still on the way in. A client that had the time that it
// has in other matches after the last fault must be in.
bool SimMatch::came_too_late(std::size_t client) const {
  if (mode_.pacing != net::Pacing::fast || over_us_ < 0) return false;
  if (faults_.has_just_come_back(client, over_us_)) return true;  // or is still cut off
  const std::uint16_t rate = simulation_->info().tick_rate;
  const std::int64_t match_ms = static_cast<std::int64_t>(setup_.ticks * 1000 / rate);
  const std::int64_t healed_ms = match_ms - heal_ms(setup_.ticks, rate);
  return !clients_.nodes()[client].client().active_tick() &&
         over_us_ - clients_.connected_us(client) < healed_ms * 1000;
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

MatchOutcome SimMatch::outcome() const {
  MatchOutcome outcome;
  outcome.failure = oracle_.failure();
  outcome.mode = mode_;
  outcome.ticks = server_->ticks_confirmed();
  outcome.comparisons = oracle_.comparisons();
  outcome.last_hash = oracle_.last_hash();
  outcome.refused_packets = sealed_.refused();
  outcome.kills = clients_.kills();
  outcome.virtual_ms = static_cast<std::uint64_t>(now_us_ / 1000);
  outcome.peak_bytes = network_.traffic().peak_bytes;
  for (const Node& node : clients_.nodes()) {
    outcome.client_ticks += node.ticks();
    outcome.resends += node.resends();
    outcome.refused_packets += node.refused_packets();
    outcome.rollbacks += node.rollbacks();
  }
  for (std::size_t i = 0; i < setup_.clients; ++i) {
    const net::PlayerStats stats = server_->stats(static_cast<std::uint8_t>(i));
    outcome.substituted_inputs += stats.substituted_inputs;
    outcome.entries += stats.entries;
  }
  return outcome;
}

void SimMatch::tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                              std::optional<std::uint64_t> hash) {
  oracle_.confirmed(tick, inputs, hash);
  if (hash) log_.record(tick, inputs, *hash, *simulation_);
}

void SimMatch::commands_confirmed(std::uint64_t, std::span<const PlayerCommand> commands) {
  oracle_.commands_confirmed(commands);
  if (simulation_ != nullptr) log_.commands(commands);
}

void SimMatch::player_left(std::uint8_t slot, net::LeaveReason reason) {
  const Node& node = clients_.nodes()[slot];
  // A client that has not entered, or was refused, is another life of the one that was lost.
  const bool is_inside = node.alive() && node.client().state() >= net::ClientState::lobby &&
                         node.client().state() != net::ClientState::refused;
  const bool expected =
      clients_.is_liar(slot) || !is_inside || reason == net::LeaveReason::left ||
      reason == net::LeaveReason::match_over || reason == net::LeaveReason::disconnected ||
      (reason == net::LeaveReason::timed_out && faults_.has_just_come_back(slot, now_us_));
  if (!expected) {
    oracle_.fail(fmt::format("tick {}: client {} was lost: {}", server_->ticks_confirmed(), slot,
                             to_string(reason)));
  }
}

void SimMatch::desync_found(const net::DesyncReport& report) {
  reports_.push_back(report);
  reports_.back().dump_here = {};
  reports_.back().dump_there = {};
  if (!setup_.control && !clients_.is_liar(report.slot))
    oracle_.fail("unexplained: " + report.to_line());
}

}  // namespace

MatchOutcome run_match(const Game& game, const MatchSetup& setup) {
  return SimMatch(game, setup).run();
}

}  // namespace lockstone::simnet
