// A whole match over the simulated network: one server, its clients, scripted inputs, all recorded.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_secure.h>
#include <lockstone/net/transport_sim.h>

#include "tests/net/security/secure_fixture.h"
#include "tools/simnet/lying_transport.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::net::test {

using lockstone::toy::ToyConfig;
using lockstone::toy::ToySimulation;

inline constexpr std::int64_t k_second_us = 1'000'000;

/// A command as a peer saw it.
struct SeenCommand {
  std::uint8_t slot = 0;
  std::vector<std::byte> bytes;
  friend bool operator==(const SeenCommand&, const SeenCommand&) = default;
};

/// One tick as a peer saw it, comparable.
struct SeenTick {
  std::vector<std::byte> bytes;  ///< all slots' inputs
  std::vector<InputOrigin> origins;
  std::vector<SeenCommand> commands;
  friend bool operator==(const SeenTick&, const SeenTick&) = default;
};

/// A peer's record of a match.
struct Seen {
  std::vector<SeenTick> ticks;
  std::vector<std::uint64_t> hashes;
  void add(std::span<const PlayerInput> inputs);
  /// Of the tick that is added next.
  void add_commands(std::span<const PlayerCommand> commands);
  std::vector<SeenCommand> next_commands;
  [[nodiscard]] std::size_t command_count() const;
};

/// A bit to flip in live state, right after `tick` was stepped.
struct Flip {
  std::uint64_t tick = 0;
  std::string store, field;
  std::uint64_t object = 0;
  unsigned bit = 0;
};

/// A toy whose memory is faulty.
class FaultySimulation final : public Simulation {
 public:
  /// A blind one's hash knows the tick alone.
  FaultySimulation(const ToyConfig& config, std::vector<Flip> flips, bool blind = false)
      : toy_(config), flips_(std::move(flips)), blind_(blind) {}
  [[nodiscard]] SimulationInfo info() const override { return toy_.info(); }
  [[nodiscard]] std::uint64_t tick() const override { return toy_.tick(); }
  void step(std::span<const PlayerInput> inputs) override;
  void command(const PlayerCommand& command) override { toy_.command(command); }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return toy_.snapshot_bytes_max(kind);
  }
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    return toy_.save(kind, out);
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return toy_.load(kind, bytes); }
  [[nodiscard]] std::uint64_t hash() const override { return blind_ ? toy_.tick() : toy_.hash(); }
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    return toy_.part_hashes(out);
  }
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return toy_.describe(here, there);
  }
  [[nodiscard]] ToySimulation& toy() { return toy_; }

 private:
  ToySimulation toy_;
  std::vector<Flip> flips_;
  bool blind_;
};

/// A client that lies about its states, from a tick on.
struct Liar {
  simnet::Lie lie = simnet::Lie::none;
  std::uint64_t from = 0;
};

/// Plays the inputs of toy_input.
class ScriptedInputs final : public InputSource {
 public:
  ScriptedInputs(std::uint64_t seed, std::size_t slot) : seed_(seed), slot_(slot) {}
  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    lockstone::toy::toy_input(seed_, slot_, tick, out);
  }

 private:
  std::uint64_t seed_;
  std::size_t slot_;
};

struct ServerLog final : ServerObserver {
  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override;
  void commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands) override;
  void hash_agreed(std::uint64_t tick, std::uint64_t hash) override;
  void player_left(std::uint8_t slot, LeaveReason reason) override;
  void player_silent(std::uint8_t slot, std::int64_t silent_us) override;
  void player_refused(const Refusal& refusal) override { refusals.push_back(refusal); }
  void desync_found(const DesyncReport& report) override;
  void match_finished(FinishReason, std::uint64_t, std::optional<std::uint64_t> hash) override {
    final_hash = hash;
  }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    active.emplace_back(slot, tick);
  }
  void player_asks(std::uint8_t slot, AskKind kind, std::uint8_t topic,
                   std::uint8_t choice) override {
    asked.push_back({slot, kind, topic, choice});
  }

  struct Asked {
    std::uint8_t slot;
    AskKind kind;
    std::uint8_t topic, choice;
    friend bool operator==(const Asked&, const Asked&) = default;
  };

  Seen seen;
  std::vector<std::uint64_t> agreed;
  std::vector<std::pair<std::uint8_t, LeaveReason>> left;
  std::vector<std::uint8_t> silent;
  std::vector<std::pair<std::uint8_t, std::uint64_t>> active;
  std::vector<Asked> asked;
  std::vector<Refusal> refusals;
  std::vector<DesyncReport> reports;
  std::vector<std::size_t> dump_sizes;
  std::optional<std::uint64_t> final_hash;
};

struct ClientLog final : ClientObserver {
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                    std::uint64_t hash) override;
  void desync_reported(const DesyncReport& report) override { reports.push_back(report); }
  void commands_stepped(std::uint64_t tick, std::span<const PlayerCommand> commands) override;
  void command_refused(std::uint64_t number) override { refused.push_back(number); }
  void state_loaded(std::uint64_t ticks) override {
    seen = {};
    first_tick = ticks;
  }
  void rolled_back(std::uint64_t, std::uint64_t count) override {
    longest_rollback = std::max(longest_rollback, count);
  }
  void input_replaced(std::uint64_t tick) override { replaced.push_back(tick); }
  Seen seen;
  std::uint64_t first_tick = 0;  ///< `seen` begins here
  std::uint64_t longest_rollback = 0;
  std::vector<std::uint64_t> replaced;
  std::vector<std::uint64_t> refused;
  std::vector<DesyncReport> reports;
};

struct MatchOptions {
  ToyConfig toy;
  ServerConfig server;  ///< match_config, info and insecure are filled in
  ClientConfig client;  ///< insecure and wanted_slot are filled in; a name gets the slot behind it
  LinkFaults faults;
  std::uint64_t seed = 1;
  bool authoritative = true;
  bool secure = false;
  bool blind = false;  ///< in a relay: hashes of 64 bits show nothing
  std::int64_t step_us = 4'000;
  std::vector<std::vector<Flip>> flips;  ///< by client; may be shorter
  std::vector<Liar> liars;               ///< likewise
};

/// `seed` is the toy's and the network's.
MatchOptions match_of(std::uint8_t players, std::uint64_t ticks, std::uint64_t seed);

class Match {
 public:
  struct Player {
    SimTransport* transport = nullptr;
    std::unique_ptr<SecureTransport> secure;        ///< around it, if the match is
    std::unique_ptr<simnet::LyingTransport> lying;  ///< around that, if it lies
    std::unique_ptr<ScriptedInputs> inputs;
    std::unique_ptr<ClientLog> log;
    std::unique_ptr<Client> client;
    bool paused = false;
  };

  explicit Match(MatchOptions options);

  /// One more client, which has begun to connect; `wanted_slot` as in ClientConfig.
  Player& add_player(std::uint8_t wanted_slot, std::uint64_t rejoin_key = 0);

  /// A new connection for a client that has lost its own.
  [[nodiscard]] bool reconnect(Player& player);

  /// Runs until everybody is done, or for `limit_us` of virtual time. True if all are done.
  bool run(std::int64_t limit_us);
  void run_for(std::int64_t span_us);
  void step();

  [[nodiscard]] bool done() const;

  /// Checks that every peer saw the same ticks and hashes, and that a run without a network of the
  /// same inputs has them too. Reports by GoogleTest expectations.
  void expect_all_equal() const;

  MatchOptions options;
  SimNetwork network;
  SimTransport& server_transport;
  TestRandom random{1};
  std::unique_ptr<SecureTransport> server_secure;
  ToySimulation server_simulation;
  ServerLog server_log;
  std::unique_ptr<Server> server;
  std::vector<Player> players;
  std::int64_t now_us = 0;
};

/// A rough network: loss in ppm, bursts, doubles, reordering, 30 ms ± jitter.
[[nodiscard]] LinkFaults rough(std::uint32_t loss_ppm);

}  // namespace lockstone::net::test
