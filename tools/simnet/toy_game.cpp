#include "tools/simnet/toy_game.h"

#include <array>
#include <memory>
#include <utility>

#include "net/transport/random.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::simnet {
namespace {

struct Flip {
  Control place;
  unsigned bit = 0;
};

class BrokenToy final : public Simulation {
 public:
  BrokenToy(const toy::ToyConfig& config, const std::optional<Flip>& flip, bool forgets)
      : toy_(config), flip_(flip), forgets_(forgets) {}

  [[nodiscard]] SimulationInfo info() const override { return toy_.info(); }
  [[nodiscard]] std::uint64_t tick() const override { return toy_.tick(); }
  void step(std::span<const PlayerInput> inputs) override {
    const std::uint64_t tick = toy_.tick();
    toy_.step(inputs);
    if (!flip_ || flip_->place.tick != tick || std::exchange(flipped_, true)) return;
    static_cast<void>(
        toy_.flip_bit(flip_->place.store, flip_->place.object, flip_->place.field, flip_->bit));
  }
  [[nodiscard]] std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return toy_.snapshot_bytes_max(kind);
  }
  // The last word saved is the last body's heat: what is loaded instead is always the same.
  [[nodiscard]] std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    const std::size_t size = toy_.save(kind, out);
    if (forgets_) ByteWriter(out.subspan(size - 8)).put(std::uint64_t{1});
    return size;
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return toy_.load(kind, bytes); }
  [[nodiscard]] std::uint64_t hash() const override { return toy_.hash(); }
  [[nodiscard]] StateDifference describe(ByteView here, ByteView there) const override {
    return toy_.describe(here, there);
  }

 private:
  toy::ToySimulation toy_;
  std::optional<Flip> flip_;
  bool flipped_ = false;
  bool forgets_;
};

SimulationFactory broken_factory(const std::optional<Flip>& flip, bool forgets) {
  return [flip, forgets](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const Result<toy::ToyConfig> config = toy::ToyConfig::decode(bytes);
    if (!config) return config.status();
    return std::unique_ptr<Simulation>(std::make_unique<BrokenToy>(config.value(), flip, forgets));
  };
}

Flip draw_flip(std::uint64_t seed, const toy::ToyConfig& config, std::uint64_t ticks) {
  constexpr std::array<const char*, 6> k_fields{"position.x", "position.y", "velocity.x",
                                                "velocity.y", "spin",       "heat"};
  net::Random random(seed ^ 0xf11b);
  Flip flip;
  flip.place.client = static_cast<std::size_t>(random.below(config.player_count));
  flip.place.tick = random.below(ticks);
  flip.place.store = "body";
  flip.place.object = random.below(config.body_count);
  flip.place.field = k_fields[static_cast<std::size_t>(random.below(k_fields.size()))];
  flip.bit = static_cast<unsigned>(random.below(64));
  return flip;
}

}  // namespace

Game make_toy_game(std::uint64_t seed, std::size_t clients, std::uint64_t ticks, Defect defect,
                   std::optional<Control>& control) {
  toy::ToyConfig config;
  config.seed = seed;
  config.player_count = static_cast<std::uint8_t>(clients);
  Game game;
  game.config = config.encode();
  game.factory = toy::toy_factory();
  game.faulty_factory = game.factory;
  if (defect == Defect::flipped_bit) {
    const Flip flip = draw_flip(seed, config, ticks);
    control = flip.place;
    game.faulty_factory = broken_factory(flip, false);
  }
  if (defect == Defect::unsaved) {
    game.factory = broken_factory(std::nullopt, true);
    game.faulty_factory = game.factory;
  }
  return game;
}

}  // namespace lockstone::simnet
