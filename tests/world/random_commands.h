// Commands at random, all kinds of them, from sensible to absurd.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <lockstone/world.h>

#include "tests/support/random.h"

namespace lockstone::test {

#define LKS_COUNT_COMMAND(Name) +1
inline constexpr std::size_t k_command_kinds = 0 LKS_COMMANDS(LKS_COUNT_COMMAND);
#undef LKS_COUNT_COMMAND

/// Draws commands for one world. Of `wild` dice about half of the commands name objects that do not
/// exist, or hold values at and beyond the ends of their ranges.
class CommandDice {
 public:
  CommandDice(const World& world, Random& random, bool wild)
      : world_(world), random_(random), wild_(wild) {}

  [[nodiscard]] Command any();

 private:
#define LKS_DECLARE_FILL(Name) void fill(Name& command);
  LKS_COMMANDS(LKS_DECLARE_FILL)
#undef LKS_DECLARE_FILL

  [[nodiscard]] bool chance(std::size_t one_in) {
    return random_.below(one_in) == 0;
  }
  [[nodiscard]] bool goes_wild() {
    return wild_ && chance(6);
  }
  [[nodiscard]] BodyHandle body();
  [[nodiscard]] JointHandle joint();
  [[nodiscard]] Quat turn();
  [[nodiscard]] Frame frame();
  [[nodiscard]] Surface surface();
  [[nodiscard]] PairSurface pair_surface();
  [[nodiscard]] EventSettings events();
  [[nodiscard]] BodyDef body_def();
  [[nodiscard]] std::uint8_t axis();

  /// Within ±reach; wild: any bits, and often the greatest, the least and their neighbours.
  template <class Quantity>
  [[nodiscard]] Quantity number(Quantity reach);
  template <class Quantity>
  [[nodiscard]] Vec3<Quantity> vector(Quantity reach) {
    return {number(reach), number(reach), number(reach)};
  }
  template <class Axis>
  void fill_axis(Axis& axis);

  const World& world_;
  Random& random_;
  bool wild_;
};

/// A small crowd on a ground that soon falls asleep, with joints, kinematic bodies and a trigger.
/// Its stores have little room left.
[[nodiscard]] WorldDef crowd_def();
[[nodiscard]] std::shared_ptr<const AssetSet> crowd_assets();
[[nodiscard]] World make_crowd(Random& random);

/// The reports of the last step: events and joint events, as numbers.
[[nodiscard]] std::vector<std::int64_t> told_by(const World& world);

}  // namespace lockstone::test
