#include "tools/fuzz/scene_fuzz.h"

#include <algorithm>
#include <array>
#include <mutex>

#include <fmt/format.h>

#include "tools/fuzz/random_scene.h"
#include "tools/support/for_blocks.h"

namespace lockstone::fuzz {
namespace {

constexpr std::uint64_t k_load_every = 7;  // ticks

thread_local std::uint64_t this_threads_scene = 0;

bool is_within(const Vec3<Position>& place) {
  return std::max({abs(place.x), abs(place.y), abs(place.z)}) <= k_world_limit;
}

// Each axis alone, and a rounding more than the limit of the whole.
bool is_slow(const Vec3<Velocity>& velocity) {
  const Velocity most = k_speed_limit + Velocity::from_ratio(1, 1000);
  return std::max({abs(velocity.x), abs(velocity.y), abs(velocity.z)}) <= most;
}

// Empty when all is well.
std::string complaint_about(const World& world) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle handle = world.body_at(i);
    if (handle.is_null()) continue;
    const BodyView body = world.body(handle);
    if (!is_within(body.centre_of_mass))
      return fmt::format(
          "body {} left the world (motion {}, kind {}, at {} {} {}, velocity {} {} {})", i,
          static_cast<int>(body.motion), static_cast<int>(body.shape.kind),
          body.centre_of_mass.x.raw >> 32, body.centre_of_mass.y.raw >> 32,
          body.centre_of_mass.z.raw >> 32, body.velocity.x.raw >> 32, body.velocity.y.raw >> 32,
          body.velocity.z.raw >> 32);
    if (!is_slow(body.velocity)) return fmt::format("body {} is faster than anything may be", i);
  }
  return {};
}

class SceneRun {
 public:
  SceneRun(const RandomScene& scene)
      : scene_(scene),
        plain_(scene.make(BroadPhaseKind::tree)),
        other_(scene.make(BroadPhaseKind::sweep_and_prune)),
        bytes_(plain_.snapshot_bytes_max(SnapshotKind::canonical)) {}

  // Runs one more tick; returns the violated invariant, if any.
  std::string tick(SceneFuzzReport& report) {
    scene_.drive(plain_);
    scene_.drive(other_);
    other_.drop_derived();
    const StepReport done = plain_.step();
    const StepReport again = other_.step();
    count(done, report);
    if (done != again) return "the report depends on derived data";
    if (plain_.hash().total != other_.hash().total) return difference();
    if (std::string what = difference_of_events(plain_, other_); !what.empty()) return what;
    report.hits += hit_events(plain_).size();
    if (has_other_contacts()) return "the contacts of a body differ";
    if (plain_.tick() % k_load_every == 0) {
      const std::size_t size = plain_.save(SnapshotKind::canonical, bytes_);
      const Status status = other_.load(SnapshotKind::canonical, ByteView(bytes_).first(size));
      if (status != Status::ok) return fmt::format("load refuses the state: {}", to_string(status));
      for (const World* world : {&plain_, &other_})
        if (const WorldFault fault = world->find_fault())
          return fmt::format("{} does not fit, {}", fault.what, fault.index);
    }
    return complaint_about(plain_);
  }

  [[nodiscard]] std::uint64_t ticks() const { return plain_.tick(); }

 private:
  static void count(const StepReport& done, SceneFuzzReport& report) {
    ++report.ticks;
    report.contacts += done.contacts;
    report.impacts += done.impacts;
    report.saturations += done.saturations;
    report.exhausted += done.status == Status::ok ? 0U : 1U;
  }

  // Of one body after the other.
  [[nodiscard]] bool has_other_contacts() const {
    if (plain_.body_limit() == 0) return false;
    const BodyHandle body =
        plain_.body_at(static_cast<std::uint32_t>(plain_.tick() % plain_.body_limit()));
    std::array<BodyContact, 16> here{}, there{};
    const std::size_t count = contacts_of(plain_, body, here);
    return contacts_of(other_, body, there) != count || here != there;
  }

  std::string difference() {
    std::vector<std::byte> there(bytes_.size());
    const std::size_t here_size = plain_.save(SnapshotKind::canonical, bytes_);
    const std::size_t there_size = other_.save(SnapshotKind::canonical, there);
    const StateDifference found = plain_.describe_difference(ByteView(bytes_).first(here_size),
                                                             ByteView(there).first(there_size));
    return fmt::format("the state depends on derived data: {} {} {}", found.store, found.object,
                       found.field);
  }

  const RandomScene& scene_;
  World plain_, other_;
  std::vector<std::byte> bytes_;
};

void run_scene(const SceneFuzzOptions& options, std::uint64_t index, SceneFuzzReport& report) {
  this_threads_scene = index;
  const RandomScene scene(options.seed, index, options.with_rims);
  SceneRun run(scene);
  ++report.scenes;
  for (std::uint32_t tick = 0; tick < options.ticks; ++tick) {
    std::string what = run.tick(report);
    if (what.empty()) continue;
    report.failures.push_back({index, run.ticks(), std::move(what)});
    return;
  }
}

void add(SceneFuzzReport& sum, SceneFuzzReport&& part) {
  sum.scenes += part.scenes;
  sum.ticks += part.ticks;
  sum.contacts += part.contacts;
  sum.impacts += part.impacts;
  sum.hits += part.hits;
  sum.saturations += part.saturations;
  sum.exhausted += part.exhausted;
  for (SceneFailure& failure : part.failures)
    sum.failures.push_back(std::move(failure));
}

}  // namespace

std::uint64_t scene_at_hand() {
  return this_threads_scene;
}

SceneFuzzReport fuzz_scenes(const SceneFuzzOptions& options) {
  SceneFuzzReport sum;
  std::mutex mutex;
  tool::for_blocks(options.count, 1, options.threads, [&](std::uint64_t i, std::uint64_t /*one*/) {
    SceneFuzzReport part;
    run_scene(options, options.first + i, part);
    const std::lock_guard lock(mutex);
    add(sum, std::move(part));
  });
  std::ranges::sort(sum.failures, {}, &SceneFailure::index);
  return sum;
}

}  // namespace lockstone::fuzz
