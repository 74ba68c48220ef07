#include "tests/net/match_fixture.h"

#include <gtest/gtest.h>

namespace lockstone::net::test {

void Seen::add(std::span<const PlayerInput> inputs) {
  SeenTick tick;
  for (const PlayerInput& input : inputs) {
    tick.bytes.insert(tick.bytes.end(), input.bytes.begin(), input.bytes.end());
    tick.origins.push_back(input.origin);
  }
  tick.commands = std::move(next_commands);
  next_commands.clear();
  ticks.push_back(std::move(tick));
}

void Seen::add_commands(std::span<const PlayerCommand> commands) {
  EXPECT_FALSE(commands.empty());
  for (const PlayerCommand& command : commands)
    next_commands.push_back({command.slot, {command.bytes.begin(), command.bytes.end()}});
}

std::size_t Seen::command_count() const {
  std::size_t count = 0;
  for (const SeenTick& tick : ticks)
    count += tick.commands.size();
  return count;
}

void FaultySimulation::step(std::span<const PlayerInput> inputs) {
  const std::uint64_t tick = toy_.tick();
  toy_.step(inputs);
  for (const Flip& flip : flips_) {
    if (flip.tick != tick) continue;
    EXPECT_TRUE(toy_.flip_bit(flip.store, flip.object, flip.field, flip.bit));
  }
}

MatchOptions match_of(std::uint8_t players, std::uint64_t ticks, std::uint64_t seed) {
  MatchOptions options;
  options.toy.player_count = players;
  options.toy.seed = seed;
  options.server.tick_count = ticks;
  options.seed = seed;
  return options;
}

void ServerLog::tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                               std::optional<std::uint64_t> hash) {
  EXPECT_EQ(tick, seen.ticks.size());
  seen.add(inputs);
  if (hash) seen.hashes.push_back(*hash);
}

void ServerLog::commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands) {
  EXPECT_EQ(tick, seen.ticks.size());
  seen.add_commands(commands);
}

void ServerLog::hash_agreed(std::uint64_t tick, std::uint64_t hash) {
  EXPECT_EQ(tick, agreed.size());
  agreed.push_back(hash);
}

void ServerLog::player_left(std::uint8_t slot, LeaveReason reason) {
  left.emplace_back(slot, reason);
}

void ServerLog::player_silent(std::uint8_t slot, std::int64_t silent_us) {
  EXPECT_GT(silent_us, 0);
  silent.push_back(slot);
}

void ServerLog::desync_found(const DesyncReport& report) {
  dump_sizes.push_back(report.dump_here.size());
  dump_sizes.push_back(report.dump_there.size());
  reports.push_back(report);
  reports.back().dump_here = {};
  reports.back().dump_there = {};
}

void ClientLog::tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                             std::uint64_t hash) {
  EXPECT_EQ(tick, first_tick + seen.ticks.size());
  seen.add(inputs);
  seen.hashes.push_back(hash);
}

void ClientLog::commands_stepped(std::uint64_t tick, std::span<const PlayerCommand> commands) {
  EXPECT_EQ(tick, first_tick + seen.ticks.size());
  seen.add_commands(commands);
}

Match::Match(MatchOptions match_options)
    : options(std::move(match_options)),
      network(options.seed),
      server_transport(network.add_endpoint()),
      server_simulation(options.toy) {
  options.server.insecure = !options.secure;
  options.server.match_config = options.toy.encode();
  options.server.info = server_simulation.info();
  ServerParts parts;
  parts.transport = &server_transport;
  if (options.secure) {
    server_secure = serve_securely(server_transport, random);
    parts.transport = server_secure.get();
  }
  parts.simulation = options.authoritative ? &server_simulation : nullptr;
  parts.describer = &server_simulation;
  parts.observer = &server_log;
  server = std::move(Server::create(options.server, parts).server);
  for (std::uint8_t slot = 0; slot < options.toy.player_count; ++slot)
    add_player(slot);
}

Match::Player& Match::add_player(std::uint8_t wanted_slot, std::uint64_t rejoin_key) {
  const std::size_t index = players.size();
  Player& player = players.emplace_back();
  player.transport = &network.add_endpoint();
  player.inputs = std::make_unique<ScriptedInputs>(options.seed, wanted_slot);
  player.log = std::make_unique<ClientLog>();
  ClientConfig config = options.client;
  config.insecure = !options.secure;
  config.wanted_slot = wanted_slot;
  if (!config.name.empty()) config.name += std::to_string(wanted_slot);
  config.rejoin_key = rejoin_key;
  ClientParts client_parts;
  client_parts.transport = player.transport;
  if (options.secure) {
    player.secure = join_securely(*player.transport, wanted_slot, random);
    client_parts.transport = player.secure.get();
  }
  const Liar liar = index < options.liars.size() ? options.liars[index] : Liar{};
  if (liar.lie != simnet::Lie::none) {
    player.lying = std::make_unique<simnet::LyingTransport>(*client_parts.transport, liar.lie,
                                                            liar.from, options.toy.input_bytes);
    client_parts.transport = player.lying.get();
  }
  client_parts.connection = network.connect(*player.transport, server_transport, options.faults);
  std::vector<Flip> flips;
  if (index < options.flips.size()) flips = options.flips[index];
  client_parts.factory =
      [flips, blind = options.blind](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const Result<ToyConfig> toy = ToyConfig::decode(bytes);
    if (!toy) return toy.status();
    return std::unique_ptr<Simulation>(
        std::make_unique<FaultySimulation>(toy.value(), flips, blind));
  };
  client_parts.inputs = player.inputs.get();
  client_parts.observer = player.log.get();
  player.client = std::move(Client::create(config, std::move(client_parts)).client);
  return player;
}

bool Match::reconnect(Player& player) {
  return player.client->reconnect(
      network.connect(*player.transport, server_transport, options.faults));
}

void Match::step() {
  server->update(now_us);
  for (Player& player : players) {
    if (!player.paused) player.client->update(now_us);
  }
  now_us += options.step_us;
}

bool Match::done() const {
  for (const Player& player : players) {
    if (!player.paused && player.client->state() < ClientState::finished) return false;
  }
  return server->state() == ServerState::over;
}

bool Match::run(std::int64_t limit_us) {
  const std::int64_t end_us = now_us + limit_us;
  while (now_us < end_us && !done())
    step();
  return done();
}

void Match::run_for(std::int64_t span_us) {
  const std::int64_t end_us = now_us + span_us;
  while (now_us < end_us)
    step();
}

void Match::expect_all_equal() const {
  SCOPED_TRACE("seed " + std::to_string(options.seed));
  const Seen& truth = server_log.seen;
  ToySimulation alone(options.toy);
  std::vector<std::uint64_t> hashes;
  for (const SeenTick& tick : truth.ticks) {
    std::vector<PlayerInput> inputs;
    for (std::size_t slot = 0; slot < tick.origins.size(); ++slot) {
      const std::size_t size = options.toy.input_bytes;
      inputs.push_back({ByteView(tick.bytes).subspan(slot * size, size), tick.origins[slot]});
    }
    std::vector<PlayerCommand> commands;
    for (const SeenCommand& command : tick.commands)
      commands.push_back({command.slot, command.bytes});
    step_tick(alone, inputs, commands);
    hashes.push_back(alone.hash());
  }
  EXPECT_TRUE(truth.hashes == hashes || !options.authoritative);
  for (const Player& player : players) {
    const Seen& seen = player.log->seen;
    const auto first = static_cast<std::size_t>(player.log->first_tick);
    ASSERT_LE(first + seen.ticks.size(), truth.ticks.size());
    for (std::size_t i = 0; i < seen.ticks.size(); ++i) {
      ASSERT_TRUE(seen.ticks[i] == truth.ticks[first + i]) << "tick " << first + i;
      ASSERT_EQ(seen.hashes[i], hashes[first + i]) << "tick " << first + i;
    }
  }
}

LinkFaults rough(std::uint32_t loss_ppm) {
  LinkFaults faults;
  faults.loss_ppm = loss_ppm;
  faults.burst_start_ppm = 10'000;
  faults.duplicate_ppm = 50'000;
  faults.reorder_ppm = 50'000;
  faults.delay_us = 15'000;
  faults.jitter_us = 20'000;
  return faults;
}

}  // namespace lockstone::net::test
