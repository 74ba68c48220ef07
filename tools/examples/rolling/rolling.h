// The game of docs/how-to/embed.md; a test compares the two.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <lockstone/hash.h>
#include <lockstone/literals.h>
#include <lockstone/rollback_history.h>
#include <lockstone/world.h>

using namespace lockstone;
using namespace lockstone::literals;

// Input of one player for one tick: push along x, push along z, jump or not. Any bytes are legal.
constexpr std::size_t k_input_bytes = 3;

class RollingGame final : public Simulation {
 public:
  explicit RollingGame(std::uint8_t players)
      : players_(players), world_(World::create({.body_capacity = k_max_players + 1}).value()) {
    BodyDef floor{.motion = MotionType::static_body, .shape = Shape::box(20_m, 0.5_m, 20_m)};
    floor.position = {{}, -0.5_m, {}};
    (void)world_.create_body(floor);
    for (int slot = 0; slot < players; ++slot) {
      BodyDef ball{.shape = Shape::sphere(0.5_m)};
      ball.position = {Position::from_integer(2 * slot), 0.5_m, {}};
      balls_[static_cast<std::size_t>(slot)] = world_.create_body(ball).value();
    }
  }

  SimulationInfo info() const override {
    return {.abi = k_simulation_abi,  // of the core; add a number of your own for your rules
            .config_hash = config_hash(world_.def()),
            .scene_hash = RollingGame(players_).hash(),
            .canary = canary_hash(),
            .tick_rate = world_.def().tick_rate,
            .player_count = players_,
            .input_bytes = k_input_bytes};
  }

  std::uint64_t tick() const override { return world_.tick(); }

  // Inputs become commands, in slot order; then the world steps.
  void step(std::span<const PlayerInput> inputs) override {
    for (std::size_t slot = 0; slot < inputs.size(); ++slot) act(slot, inputs[slot].bytes);
    (void)history_.step();
  }

  // State: the data of the rules, then the world. Nothing that changes the future may be missing
  // here, or in hash().
  std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return sizeof jumps_ + world_.snapshot_bytes_max(kind);
  }
  std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    ByteWriter writer(out);
    for (std::uint32_t jumps : jumps_) writer.put(jumps);
    return writer.size() + world_.save(kind, out.subspan(writer.size()));
  }
  Status load(SnapshotKind kind, ByteView bytes) override {
    ByteReader reader(bytes);
    decltype(jumps_) jumps;
    for (std::uint32_t& count : jumps) count = reader.get<std::uint32_t>();
    if (!reader.ok()) return Status::truncated;
    const Status status = world_.load(kind, reader.get_bytes(reader.remaining()));
    if (status == Status::ok) jumps_ = jumps;  // all of it, or nothing
    return status;
  }
  std::uint64_t hash() const override { return hash_jumps(world_.hash().total); }

  // For clients that predict: a tick that is stepped again costs as much as differs.
  void keep_history(std::uint32_t ticks) override { history_ = RollbackHistory(world_, ticks); }
  void forget_history() override { history_.forget(); }

  // To locate differences: first the part of the state, then, for people, the field.
  std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override {
    const StateHash128 world = world_.hash128();
    out[0] = {"jumps", {hash_jumps(0), 0}};
    out[1] = {"bodies", world.bodies};
    out[2] = {"contacts", world.contacts};
    return 3;
  }

  StateDifference describe(ByteView here, ByteView there) const override {
    if (here.size() < sizeof jumps_ || there.size() < sizeof jumps_) return {};
    ByteReader left(here), right(there);
    for (std::size_t slot = 0; slot < k_max_players; ++slot) {
      const auto a = left.get<std::uint32_t>(), b = right.get<std::uint32_t>();
      if (a != b) return {true, "player", slot, {}, "jumps", std::to_string(a), std::to_string(b)};
    }
    return world_.describe_difference(here.subspan(sizeof jumps_), there.subspan(sizeof jumps_));
  }

  World& world() { return world_; }  // for the tools, to look at

 private:
  std::uint64_t hash_jumps(std::uint64_t seed) const {
    std::array<std::byte, sizeof jumps_> bytes;
    ByteWriter writer(bytes);
    for (std::uint32_t jumps : jumps_) writer.put(jumps);
    return hash64(writer.written(), seed);
  }
  void act(std::size_t slot, ByteView bytes) {
    const BodyHandle ball = balls_[slot];
    const auto push = [&](std::size_t i) {
      return Impulse::from_integer(static_cast<std::int8_t>(bytes[i]) / 8);
    };
    (void)world_.apply(ApplyImpulse{ball, {push(0), {}, push(1)}});
    const RayHit below = world_.cast_ray(world_.position(ball), {{}, -0.55_m, {}}, {.ignore = ball});
    if (bytes[2] == std::byte{0} || below.body.is_null()) return;
    (void)world_.apply(ApplyImpulse{ball, {{}, 2000_Ns, {}}});
    ++jumps_[slot];
  }

  std::uint8_t players_;
  World world_;
  RollbackHistory history_{world_};  // steps it
  std::array<BodyHandle, k_max_players> balls_{};  // follows from the construction: not state
  std::array<std::uint32_t, k_max_players> jumps_{};
};

inline Result<std::unique_ptr<Simulation>> make_game(ByteView config) {
  if (config.size() != 1) return Status::malformed;
  const auto players = static_cast<std::uint8_t>(config[0]);
  if (players < 1 || players > k_max_players) return Status::invalid_argument;
  return std::unique_ptr<Simulation>(std::make_unique<RollingGame>(players));
}
