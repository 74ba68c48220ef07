// A deterministic game of a few dozen integer bodies, for trying out `net` and `replay`.
//
// Every player pushes one body around; bodies drift, bounce and pass momentum on. The state is a
// flat list of 64-bit words, so that saving, hashing, describing and flipping a bit are one loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::toy {

/// The configuration of a match of the toy. `encode` and `decode` give the configuration bytes.
struct ToyConfig {
  std::uint64_t seed = 1;
  std::uint16_t tick_rate = 60;   ///< ticks per second, 1 … 1000
  std::uint16_t body_count = 24;  ///< player_count … 256
  std::uint8_t player_count = 2;  ///< 1 … k_max_players
  std::uint8_t input_bytes =
      4;  ///< 4 … k_max_input_bytes; bytes after the fourth are only mixed in

  [[nodiscard]] std::vector<std::byte> encode() const;
  [[nodiscard]] static Result<ToyConfig> decode(ByteView bytes);
};

/// The game. Input bytes of a player: push x (int8), push y (int8), buttons, target body.
class ToySimulation : public Simulation {
 public:
  explicit ToySimulation(const ToyConfig& config);

  [[nodiscard]] SimulationInfo info() const override { return info_; }
  [[nodiscard]] std::uint64_t tick() const override { return words_[0]; }
  void step(std::span<const PlayerInput> inputs) override;
  /// Changes the world's random number, and gives a player a point for each 1000 bytes.
  void command(const PlayerCommand& command) override;
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override;
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override;
  Status load(SnapshotKind kind, ByteView bytes) override;
  [[nodiscard]] std::uint64_t hash() const override;
  [[nodiscard]] std::size_t part_hashes(std::span<PartHash, k_max_state_parts> out) const override;
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override;

  /// Test hook: flips one bit of live state. Stores and fields:
  /// "world": tick, random. "player": score, buttons, braking.
  /// "body": position.x, position.y, velocity.x, velocity.y, spin, heat.
  /// False, and nothing happens, when there is no such word or `bit` is above 63.
  bool flip_bit(std::string_view store, std::uint64_t object, std::string_view field, unsigned bit);

  /// Test hook: a simulation that claims to be another one.
  void override_info(const SimulationInfo& info) { info_ = info; }

 private:
  [[nodiscard]] Hash128 hash_words(std::size_t begin, std::size_t end) const;
  struct Place;  ///< the meaning of a word
  [[nodiscard]] Place place_of(std::size_t word) const;
  [[nodiscard]] std::optional<std::size_t> find(std::string_view store, std::uint64_t object,
                                                std::string_view field) const;
  [[nodiscard]] std::size_t body_word(std::size_t body, std::size_t field) const;
  [[nodiscard]] Result<std::size_t> check_canonical(ByteView bytes) const;
  void apply_input(std::size_t slot, const PlayerInput& input);
  void move_body(std::size_t body);
  void pass_momentum(std::size_t a, std::size_t b);

  ToyConfig config_;
  SimulationInfo info_;
  std::vector<std::uint64_t> words_;  ///< world, then players, then bodies
};

/// The toy with a fault that tests must find: the last body's heat is not saved, and comes back as
/// one and the same number.
class ForgetfulToy final : public ToySimulation {
 public:
  using ToySimulation::ToySimulation;
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override;
};

/// Makes the toy, or one derived from it, from ToyConfig::encode's bytes.
template <class Toy = ToySimulation, class... Further>
[[nodiscard]] SimulationFactory toy_factory(Further... further) {
  return [further...](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const Result<ToyConfig> config = ToyConfig::decode(bytes);
    if (!config) return config.status();
    return std::unique_ptr<Simulation>(std::make_unique<Toy>(config.value(), further...));
  };
}
/// A reproducible input for a slot and tick, for the players of tests. `out` is filled whole.
void toy_input(std::uint64_t seed, std::size_t slot, std::uint64_t tick, std::span<std::byte> out);

}  // namespace lockstone::toy
