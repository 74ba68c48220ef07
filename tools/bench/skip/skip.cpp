#include "tools/bench/skip/skip.h"

#include <algorithm>
#include <utility>

#include "tools/bench/skip/linked_programs.h"
#include "tools/bench/speed/city.h"
#include "tools/bench/speed/speed_scene.h"
#include "tools/bench/support/measure.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr double k_microsecond = 1000;  // ns

class Skips {
 public:
  explicit Skips(const SkipOptions& options) : options_(options) {}

  void count(std::string claim, std::string figure, std::string unit, double value, double goal) {
    figures.push_back({std::move(claim), std::move(figure), std::move(unit), value, goal});
  }
  void count_at_least(std::string claim, std::string figure, std::string unit, double value,
                      double goal) {
    count(std::move(claim), std::move(figure), std::move(unit), value, goal);
    figures.back().at_least = true;
  }

  /// The median over rounds of the time of `work(calls)`, a call.
  template <class Work>
  void time(std::string claim, std::string figure, double goal_ns, int calls, Work&& work) {
    if (!options_.times) return;
    constexpr int k_rounds = 15;
    std::vector<double> rounds;
    for (int i = 0; i < k_rounds; ++i) {
      const std::uint64_t begin = thread_nanoseconds();
      work(calls);
      rounds.push_back(static_cast<double>(thread_nanoseconds() - begin) / calls);
    }
    count(std::move(claim), std::move(figure), "us", median(std::move(rounds)) / k_microsecond,
          goal_ns / k_microsecond);
    figures.back().is_time = true;
  }

  [[nodiscard]] const SkipOptions& options() const { return options_; }

  std::vector<SkipFigure> figures;

 private:
  SkipOptions options_;
};

void step_and_hash(World& world, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    (void)world.step();
    (void)world.hash();
  }
}

double visited(const StepReport& report) {
  return static_cast<double>(std::uint64_t{report.moving_bodies} + report.pairs + report.contacts +
                             report.continuous_bodies + report.islands);
}

void measure_sleep(Skips& skips) {
  const std::string claim = "asleep bodies cost nothing";
  World city = make_city(BroadPhaseKind::tree, 10'000);
  (void)city.hash();
  skips.count(claim, "bodies, pairs, contacts visited in a tick of 10,000 asleep", "",
              visited(city.step()), 0);
  skips.count(claim, "records hashed after it, the header among them", "", city.hash().hashed, 1);
  skips.time(claim, "a tick of 10,000 asleep, with its hash", 2 * k_microsecond, 2000,
             [&](int ticks) { step_and_hash(city, ticks); });
  if (!skips.options().times) return;
  World village = make_city(BroadPhaseKind::tree, 1'000);
  skips.time(claim, "a tick of 1,000 asleep, with its hash", 2 * k_microsecond, 2000,
             [&](int ticks) { step_and_hash(village, ticks); });
}

// A ball that rolls to and fro in a street.
void measure_one_awake(Skips& skips) {
  const std::string claim = "one awake among 10,000 asleep";
  World city = make_city(BroadPhaseKind::tree, 10'000);
  BodyDef ball = scenes::loose(Shape::sphere(0.5_m), {millimetres(1500), 0.5_m, {}});
  ball.velocity = {{}, {}, 3_mps};
  const BodyHandle body = scenes::add(city, ball);
  (void)city.step();
  (void)city.hash();
  const StepReport report = city.step();
  skips.count(claim, "bodies moved", "", report.moving_bodies, 1);
  skips.count(claim, "pairs looked at", "", report.pairs, 1);
  skips.count(claim, "records hashed, the header among them", "", city.hash().hashed, 3);
  int ticks = 0;
  const auto roll = [&](int count) {
    for (int i = 0; i < count; ++i) {
      if (ticks++ % 600 == 0) {
        const Velocity speed = ticks % 1200 < 600 ? Velocity(3_mps) : Velocity(-3_mps);
        scenes::order(city, SetVelocity{body, {{}, {}, speed}});
      }
      step_and_hash(city, 1);
    }
  };
  skips.time(claim, "a tick, with its hash", 10 * k_microsecond, 600, roll);
}

// A stage that no body needs, as a share of a tick.
void count_idle_stage(Skips& skips, const std::string& claim, World& world) {
  constexpr int k_ticks = 60;
  world.set_clock(thread_nanoseconds);
  for (int tick = 0; tick < k_ticks; ++tick)
    (void)world.step();
  const StepProfile& profile = world.profile();
  double whole = 0;
  for (const std::uint64_t stage : profile.stage_ticks)
    whole += static_cast<double>(stage);
  const double used = static_cast<double>(profile.ticks_of(StepStage::continuous)) -
                      k_ticks * clock_overhead(thread_nanoseconds);
  skips.count(claim, "of a tick's time, to follow no body", "%", 100 * std::max(used, 0.0) / whole,
              1);
  skips.figures.back().is_time = true;
}

// Twenty stacks of five boxes.
World make_stacks(WorldDef def) {
  World world = make_speed_world(def);
  scenes::add_ground(world, 50_m);
  for (int i = 0; i < 20; ++i)
    scenes::add_stack(world, {millimetres(3000 * i - 30'000), {}, {}}, 5);
  return world;
}

WorldDef stacks_def() {
  WorldDef def = speed_def(BroadPhaseKind::tree, 512, 8192, 4096);
  def.sleep_ms = 0;
  return def;
}

void measure_absent_features(Skips& skips) {
  const std::string claim = "no joints, no triggers, no continuous bodies";
  World world = make_stacks(stacks_def());
  StepReport sum;
  std::size_t triggers = 0;
  std::int64_t joints = 0;
  (void)world.hash();
  for (int tick = 0; tick < 60; ++tick) {
    const StepReport report = world.step();
    // Every joint of an awake body is hashed again.
    joints += std::max(std::int64_t{world.hash().hashed} - report.moving_bodies -
                           report.still_bodies - report.pairs - 1,
                       std::int64_t{0});
    sum.continuous_bodies += report.continuous_bodies;
    sum.impacts += report.impacts;
    triggers += static_cast<std::size_t>(
        std::ranges::count_if(world.events(), [](const ContactEvent& event) {
          return event.kind >= EventKind::trigger_enter && event.kind <= EventKind::trigger_exit;
        }));
  }
  skips.count(claim, "records hashed beyond bodies, contacts and the header", "",
              static_cast<double>(joints), 0);
  skips.count(claim, "bodies followed along their way", "", sum.continuous_bodies, 0);
  skips.count(claim, "impacts answered", "", sum.impacts, 0);
  skips.count(claim, "trigger events", "", static_cast<double>(triggers), 0);
  if (skips.options().times) count_idle_stage(skips, claim, world);
}

// A thousand rays through a world, whose answers nobody looks at.
void ask(const World& world) {
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3<Position> from{millimetres(60 * i - 30'000), 20_m, {}};
    found += world.cast_ray(from, {{}, -30_m, {}}).body.is_null() ? 0 : 1;
  }
  LKS_CHECK(found > 0);
}

// Queries must leave the tick unchanged: compares two worlds, of which one is queried.
void measure_silence(Skips& skips) {
  World silent = make_stacks(stacks_def()), asked = make_stacks(stacks_def());
  for (int tick = 0; tick < 60; ++tick) {
    (void)silent.step();
    (void)asked.step();
  }
  (void)silent.hash();
  (void)asked.hash();
  const std::uint64_t heap = heap_bytes();
  ask(asked);
  const std::string claim = "no queries";
  skips.count(claim, "bytes that 1,000 rays leave in a world", "bytes",
              static_cast<double>(heap_bytes() - heap), 0);
  (void)silent.step();
  (void)asked.step();
  skips.count(claim, "records that the next tick hashes more for them", "",
              static_cast<double>(asked.hash().hashed) - silent.hash().hashed, 0);
}

// A world that may have joints beside one that may not, in turns.
void time_possible_joints(Skips& skips) {
  if (!skips.options().times) return;
  WorldDef def = stacks_def();
  def.joint_capacity = 0;
  World without = make_stacks(def);
  def.joint_capacity = 8192;
  World with = make_stacks(def);
  const auto step = [](World& world) {
    const std::uint64_t begin = thread_nanoseconds();
    (void)world.step();
    return static_cast<double>(thread_nanoseconds() - begin);
  };
  std::vector<double> ratios;
  for (int tick = 0; tick < 401; ++tick) {
    const bool first = tick % 2 == 0;
    const double a = step(first ? without : with), b = step(first ? with : without);
    ratios.push_back(first ? b / a : a / b);
  }
  skips.count("no joints, no triggers, no continuous bodies",
              "more time with 8,192 joints possible, none there", "%",
              100 * (median(std::move(ratios)) - 1), 2);
  skips.figures.back().is_time = true;
}

void measure_linked_code(Skips& skips) {
  const auto programs = linked_programs();
  if (!programs) return;
  const std::string claim = "a program that uses spheres and boxes only";
  skips.count(claim, "functions of hulls, meshes, height fields linked", "",
              static_cast<double>(programs->primitives.assets), 0);
  skips.count_at_least(claim, "such functions in one that uses them (the control)", "",
                       static_cast<double>(programs->assets.assets), 1);
  skips.count(claim, "code, of the code of one that uses them", "%",
              100.0 * static_cast<double>(programs->primitives.bytes) /
                  static_cast<double>(programs->assets.bytes),
              80);
}

// Far apart, in the air, spinning.
StepReport fly(const Shape& shape, int bodies) {
  World world = make_speed_world(speed_def(BroadPhaseKind::tree, 1024, 8192, 4096));
  for (int i = 0; i < bodies; ++i) {
    BodyDef body =
        scenes::loose(shape, {millimetres(5000 * (i % 32)), 900_m, millimetres(5000 * (i / 32))});
    body.angular_velocity = {1_rps, 5_rps, 0.1_rps};
    scenes::add(world, body);
  }
  return world.step();
}

void measure_flight(Skips& skips) {
  const std::string claim = "free-flying bodies";
  constexpr int k_bodies = 1000;
  const StepReport boxes = fly(Shape::box(0.2_m, 0.4_m, 0.6_m), k_bodies);
  skips.count_at_least(claim, "of 1,000, on the exact path", "", boxes.free_bodies, k_bodies);
  skips.count(claim, "contacts, colours, pairs", "",
              static_cast<double>(std::uint64_t{boxes.contacts} + boxes.colors + boxes.pairs), 0);
  const StepReport balls = fly(Shape::sphere(0.5_m), k_bodies);
  skips.count("spherical inertia", "turns about principal axes of 1,000 spinning balls", "",
              balls.axis_turns, 0);
}

std::uint64_t counting_clock() {
  return 0;
}

void measure_reuse(Skips& skips) {
  World world = make_stacks(stacks_def());
  for (int tick = 0; tick < 300; ++tick)
    (void)world.step();
  world.set_clock(counting_clock, ProfileDetail::pairs);
  for (int tick = 0; tick < 60; ++tick)
    (void)world.step();
  const PairProfile& boxes = world.profile().pairs_of(ShapeKind::box, ShapeKind::box);
  skips.count_at_least("unchanged relative transform", "of manifolds in resting stacks, reused",
                       "%",
                       100.0 * static_cast<double>(boxes.reused) /
                           static_cast<double>(std::max<std::uint64_t>(boxes.manifolds, 1)),
                       1);
}

void measure_hash(Skips& skips) {
  if (!skips.options().times) return;
  World world = k_large_pyramid.make(BroadPhaseKind::tree);
  constexpr int k_ticks = 30;
  std::vector<double> ticks, hashes;
  for (int i = 0; i < k_ticks; ++i) {
    const std::uint64_t begin = thread_nanoseconds();
    (void)world.step();
    const std::uint64_t middle = thread_nanoseconds();
    (void)world.hash();
    ticks.push_back(static_cast<double>(middle - begin));
    hashes.push_back(static_cast<double>(thread_nanoseconds() - middle));
  }
  const double hash = median(std::move(hashes));
  skips.count("hash", "of a busy tick, 5,050 boxes awake", "%",
              100 * hash / (median(std::move(ticks)) + hash), 2);
  skips.figures.back().is_time = true;
}

std::size_t native_bytes(const World& world) {
  std::vector<std::byte> buffer(world.snapshot_bytes_max(SnapshotKind::native));
  return world.save(SnapshotKind::native, buffer);
}

// The bytes that each body and contact of touching boxes adds to a snapshot.
void measure_snapshot_sizes(Skips& skips) {
  World world = make_speed_world(speed_def(BroadPhaseKind::tree, 16, 64, 64));
  const std::size_t empty = native_bytes(world);
  scenes::add(world, scenes::fixed_box({}, {1_m, 1_m, 1_m}));
  const std::size_t body = native_bytes(world) - empty;
  scenes::add(world, scenes::loose(Shape::box(0.5_m, 0.5_m, 0.5_m), {{}, 1.5_m, {}}));
  const std::size_t apart = native_bytes(world);
  (void)world.step();
  skips.count("snapshot", "a body", "bytes", static_cast<double>(body), 256);
  skips.count("snapshot", "a touching pair", "bytes",
              static_cast<double>(native_bytes(world) - apart), 96);
}

// The memory that a world takes for one more of each object that its definition counts.
void measure_memory(Skips& skips) {
  if (heap_bytes() == 0) return;
  // Above the default count of converged contacts, which is measured by itself.
  constexpr std::uint32_t k_few = 2048, k_more = 10'240;
  const auto bytes_of = [](const WorldDef& def) {
    const std::uint64_t before = heap_bytes();
    const World world = make_speed_world(def);
    return static_cast<double>(heap_bytes() - before);
  };
  const auto measure = [&](std::uint32_t WorldDef::*capacity, const char* figure, double goal) {
    WorldDef few, more;
    few.*capacity = k_few;
    more.*capacity = k_more;
    skips.count("memory", figure, "bytes", (bytes_of(more) - bytes_of(few)) / (k_more - k_few),
                goal);
  };
  measure(&WorldDef::body_capacity, "a body", 3072);
  measure(&WorldDef::pair_capacity, "a pair of bodies with overlapping bounds", 96);
  measure(&WorldDef::contact_capacity, "a contact", 2048);
  measure(&WorldDef::joint_capacity, "a joint", 8192);
  WorldDef none, some;
  none.converged_contacts = 0;
  skips.count("memory", "a converged contact", "bytes",
              (bytes_of(some) - bytes_of(none)) / some.converged_contacts, 8192);
}

// Loading makes trees and lists of contacts again.
void measure_snapshot_time(Skips& skips) {
  if (!skips.options().times) return;
  for (const bool sleeping : {false, true}) {
    World world = make_city(BroadPhaseKind::tree, 800);
    if (!sleeping) {
      scenes::order(world, SetGravity{{{}, -9.8_mps2, {}}});
      (void)world.step();
    }
    std::vector<std::byte> buffer(world.snapshot_bytes_max(SnapshotKind::native));
    skips.time("snapshot", sleeping ? "800 bodies asleep saved" : "800 bodies awake saved",
               100 * k_microsecond, 50, [&](int count) {
                 for (int i = 0; i < count; ++i)
                   (void)world.save(SnapshotKind::native, buffer);
               });
    const std::size_t size = world.save(SnapshotKind::native, buffer);
    skips.time(
        "snapshot", sleeping ? "the same loaded" : "the same loaded, awake", 400 * k_microsecond,
        20, [&](int count) {
          for (int i = 0; i < count; ++i)
            LKS_CHECK(world.load(SnapshotKind::native, ByteView(buffer).first(size)) == Status::ok);
        });
  }
}

}  // namespace

std::vector<SkipFigure> measure_skips(const SkipOptions& options) {
  Skips skips(options);
  measure_sleep(skips);
  measure_one_awake(skips);
  measure_absent_features(skips);
  time_possible_joints(skips);
  measure_silence(skips);
  measure_linked_code(skips);
  measure_flight(skips);
  measure_reuse(skips);
  measure_hash(skips);
  measure_snapshot_sizes(skips);
  measure_memory(skips);
  measure_snapshot_time(skips);
  return std::move(skips.figures);
}

}  // namespace lockstone::bench
