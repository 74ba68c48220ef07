#include "tools/fuzz/vector_fuzz.h"

#include <algorithm>
#include <mutex>
#include <string_view>

#include "core/kernels/target.h"
#include "tools/fuzz/random_world.h"
#include "tools/support/for_blocks.h"

namespace lockstone::fuzz {
namespace {

using Hashes = std::vector<std::uint64_t>;  // of a world, after every tick

void tick(const RandomWorld& source, World& world) {
  source.drive(world);
  (void)world.step();  // a full store is reported, and leads to the same state everywhere
}

Hashes play(const RandomWorld& source, std::uint32_t ticks) {
  World world = source.make();
  Hashes hashes;
  hashes.reserve(ticks);
  for (std::uint32_t i = 0; i < ticks; ++i) {
    tick(source, world);
    hashes.push_back(world.hash().total);
  }
  return hashes;
}

// The kinds that are compared with `scalar`.
std::vector<std::string_view> other_kinds() {
  const auto supported = lanes::supported_targets().subspan(1);
  std::vector<std::string_view> kinds(supported.begin(), supported.end());
  kinds.emplace_back();
  return kinds;
}

class VectorFuzz {
 public:
  explicit VectorFuzz(const VectorFuzzOptions& options)
      : options_(options), expected_(options.count) {}

  VectorFuzzReport run() {
    force("scalar");
    for_worlds([this](std::uint64_t i) {
      expected_[i] = play(RandomWorld(options_.seed, options_.first + i), options_.ticks);
    });
    for (const std::string_view kind : other_kinds())
      compare(kind);
    std::ranges::stable_sort(report_.failures, {}, &VectorFailure::index);
    for (VectorFailure& failure : report_.failures)
      failure.what = difference(failure);
    force({});
    report_.worlds = options_.count;
    report_.ticks = options_.count * options_.ticks;
    for (const Hashes& hashes : expected_)
      for (const std::uint64_t hash : hashes)
        report_.digest = arena::mix(report_.digest ^ hash);
    return std::move(report_);
  }

 private:
  static void force(std::string_view kind) { (void)lanes::set_target(kind); }

  template <class Function>
  void for_worlds(const Function& function) {
    tool::for_blocks(options_.count, 1, options_.threads,
                     [&](std::uint64_t i, std::uint64_t /*one*/) { function(i); });
  }

  void compare(std::string_view kind) {
    force(kind);
    ++report_.kinds;
    std::mutex mutex;
    for_worlds([&](std::uint64_t i) {
      const std::uint64_t index = options_.first + i;
      const Hashes hashes = play(RandomWorld(options_.seed, index), options_.ticks);
      const auto [at, expected] = std::ranges::mismatch(hashes, expected_[i]);
      if (at == hashes.end()) return;
      const std::lock_guard lock(mutex);
      const auto tick = static_cast<std::uint64_t>(at - hashes.begin()) + 1;
      report_.failures.push_back({index, tick, std::string(kind), {}});
    });
  }

  // Plays the world again up to the tick, of both kinds, and names the first field that differs.
  [[nodiscard]] std::string difference(const VectorFailure& failure) const {
    const RandomWorld source(options_.seed, failure.index);
    World here = source.make(), there = source.make();
    std::vector<std::byte> bytes[2];
    const auto play_to_tick = [&](std::string_view kind, World& world, std::vector<std::byte>& to) {
      force(kind);
      for (std::uint64_t i = 0; i < failure.tick; ++i)
        tick(source, world);
      to.resize(world.snapshot_bytes_max(SnapshotKind::canonical));
      to.resize(world.save(SnapshotKind::canonical, to));
    };
    play_to_tick("scalar", here, bytes[0]);
    play_to_tick(failure.vectors, there, bytes[1]);
    return here.describe_difference(bytes[0], bytes[1]).to_line();
  }

  const VectorFuzzOptions& options_;
  std::vector<Hashes> expected_;  // of each world, with `scalar`
  VectorFuzzReport report_;
};

}  // namespace

VectorFuzzReport fuzz_vectors(const VectorFuzzOptions& options) {
  return VectorFuzz(options).run();
}

}  // namespace lockstone::fuzz
