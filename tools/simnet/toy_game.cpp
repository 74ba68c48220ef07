#include "tools/simnet/toy_game.h"

#include <algorithm>
#include <array>
#include <utility>

#include "net/transport/random.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::simnet {
namespace {

struct Flip {
  Control place;
  unsigned bit = 0;
};

// One bit of it changes by itself.
class FlippedToy final : public toy::ToySimulation {
 public:
  FlippedToy(const toy::ToyConfig& config, const Flip& flip) : ToySimulation(config), flip_(flip) {}

  void step(std::span<const PlayerInput> inputs) override {
    const bool now = tick() == flip_.place.tick && !std::exchange(flipped_, true);
    ToySimulation::step(inputs);
    if (!now) return;
    static_cast<void>(
        flip_bit(flip_.place.store, flip_.place.object, flip_.place.field, flip_.bit));
  }

 private:
  Flip flip_;
  bool flipped_ = false;
};

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
  config.body_count = std::max<std::uint16_t>(config.body_count, config.player_count);
  Game game;
  game.config = config.encode();
  game.factory = toy::toy_factory();
  game.faulty_factory = game.factory;
  if (defect == Defect::flipped_bit) {
    const Flip flip = draw_flip(seed, config, ticks);
    control = flip.place;
    game.faulty_factory = toy::toy_factory<FlippedToy>(flip);
  }
  if (defect == Defect::unsaved) {
    game.factory = toy::toy_factory<toy::ForgetfulToy>();
    game.faulty_factory = game.factory;
  }
  return game;
}

}  // namespace lockstone::simnet
