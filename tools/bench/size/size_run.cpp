#include "tools/bench/size/size_run.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <lockstone/testing/floating.h>

namespace lockstone::bench {
namespace {

double time_of(Clock clock, auto&& work) {
  const std::uint64_t begin = clock();
  work();
  return static_cast<double>(clock() - begin);
}

double highest_of(const World& world) {
  Position highest = Position::min();
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (world.body(body).motion == MotionType::dynamic)
      highest = std::max(highest, world.position(body).y);
  }
  return testing::to_double(highest);
}

void play(World& world, const SizeKind& kind, Clock clock, SizeFigures& figures) {
  std::vector<double> ticks;
  for (std::uint32_t tick = 0; tick < kind.ticks; ++tick) {
    StepReport report;
    ticks.push_back(time_of(clock, [&] {
      if (kind.drive != nullptr) kind.drive(world);
      report = world.step();
    }));
    figures.moving += report.moving_bodies;
    figures.contacts += report.contacts;
    figures.had_room = figures.had_room && report.status == Status::ok;
  }
  figures.ticks = kind.ticks;
  figures.moving /= kind.ticks;
  figures.contacts /= kind.ticks;
  figures.tick_ns = std::accumulate(ticks.begin(), ticks.end(), 0.0) / kind.ticks;
  figures.tick_p99_ns = quantile(std::move(ticks), 0.99);
}

}  // namespace

SizeFigures measure_size(const SizeKind& kind, std::uint32_t bodies, Clock clock) {
  SizeFigures figures;
  figures.kind = kind.name;
  figures.bodies = bodies;
  const std::uint64_t before = heap_bytes();
  std::optional<World> world;
  figures.make_ns = time_of(clock, [&] { world.emplace(kind.make(bodies)); });
  figures.heap = heap_bytes() - before;
  play(*world, kind, clock, figures);
  (void)world->hash();
  (void)world->step();
  figures.hash_ns = time_of(clock, [&] { figures.hash = world->hash().total; });
  figures.highest = highest_of(*world);
  std::vector<std::byte> snapshot(world->snapshot_bytes_max(SnapshotKind::native));
  figures.save_ns =
      time_of(clock, [&] { figures.snapshot = world->save(SnapshotKind::native, snapshot); });
  snapshot.resize(figures.snapshot);
  figures.load_ns = time_of(clock, [&] {
    figures.had_room =
        world->load(SnapshotKind::native, snapshot) == Status::ok && figures.had_room;
  });
  const std::uint32_t destroyed = std::min(bodies, std::uint32_t{1000});
  figures.destroy_ns = time_of(clock, [&] {
    for (std::uint32_t i = 1; i <= destroyed; ++i)
      figures.had_room =
          world->apply(DestroyBody{world->body_at(world->body_limit() - i)}) == Status::ok &&
          figures.had_room;
  });
  figures.destroy_ns /= destroyed;
  return figures;
}

}  // namespace lockstone::bench
