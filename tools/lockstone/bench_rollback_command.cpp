// What rolling back costs: bytes of a native snapshot, times to save and load, ticks simulated
// anew.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench/speed/speed_scene.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"

namespace lockstone::tool {
namespace {

struct RollbackOptions {
  std::uint32_t bodies = 800;
  int ticks = 8;
  int repeats = 30;
  int settle = 120;
  bool json = false;
};

struct Figures {
  std::uint32_t bodies = 0;
  std::uint32_t contacts = 0;
  std::size_t bytes = 0;
  std::size_t header_bytes = 0;
  double body_bytes = 0;
  double contact_bytes = 0;
  double save_us = 0;
  double load_us = 0;
  double resimulate_us = 0;
  std::uint64_t hash = 0;
  bool repeated = true;  // each repeat came to the same hash
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class F>
double microseconds(F&& f) {
  const Stopwatch watch;
  f();
  return watch.seconds() * 1e6;
}

std::size_t saved_bytes(const World& world) {
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::native));
  return world.save(SnapshotKind::native, bytes);
}

// Boxes dropped into a square pit of four walls, in layers.
World make_pit(std::uint32_t boxes) {
  WorldDef def = bench::speed_def(BroadPhaseKind::tree, boxes + 8, 16 * (boxes + 8), 8 * (boxes + 8));
  World world = bench::make_speed_world(def);
  const auto fixed = [&](int x, int y, int z, int sx, int sy, int sz) {
    BodyDef body;
    body.motion = MotionType::static_body;
    body.shape =
        Shape::box(Length::from_integer(sx), Length::from_integer(sy), Length::from_integer(sz));
    body.position = {Position::from_integer(x), Position::from_integer(y),
                     Position::from_integer(z)};
    static_cast<void>(world.create_body(body));
  };
  fixed(0, -1, 0, 20, 1, 20);
  fixed(-7, 10, 0, 1, 10, 8);
  fixed(7, 10, 0, 1, 10, 8);
  fixed(0, 10, -7, 8, 10, 1);
  fixed(0, 10, 7, 8, 10, 1);
  for (std::uint32_t i = 0; i < boxes; ++i) {
    const auto column = static_cast<int>(i % 100), layer = static_cast<int>(i / 100);
    BodyDef body;
    constexpr Length half = Length::from_ratio(1, 2);
    body.shape = Shape::box(half, half, half);
    body.position = {Position::from_ratio(11 * (column % 10) - 50, 10),
                     Position::from_ratio(12 * layer + 6, 10),
                     Position::from_ratio(11 * (column / 10) - 50, 10)};
    static_cast<void>(world.create_body(body));
  }
  return world;
}

// What one record of each store takes, found by counting: two worlds that differ in bodies alone.
void measure_bytes(World& world, Figures& figures) {
  figures.bytes = saved_bytes(world);
  const World one = make_pit(1), two = make_pit(2);
  figures.body_bytes = static_cast<double>(saved_bytes(two) - saved_bytes(one));
  const World none = make_pit(0);
  figures.header_bytes =
      saved_bytes(none) - static_cast<std::size_t>(figures.body_bytes * none.body_limit());
  const double rest = static_cast<double>(figures.bytes - figures.header_bytes) -
                      figures.body_bytes * world.body_limit();
  figures.contact_bytes = figures.contacts == 0 ? 0 : rest / figures.contacts;
}

Figures measure(const RollbackOptions& options) {
  World world = make_pit(options.bodies);
  StepReport report;
  for (int tick = 0; tick < options.settle; ++tick)
    report = world.step();
  Figures figures;
  figures.bodies = world.body_count();
  figures.contacts = report.contacts;
  measure_bytes(world, figures);
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::native));
  const std::size_t size = world.save(SnapshotKind::native, bytes);
  const ByteView snapshot = ByteView(bytes).first(size);
  std::vector<std::byte> scratch(bytes.size());
  std::vector<double> saves, loads, steps;
  for (int i = 0; i < options.repeats; ++i) {
    loads.push_back(
        microseconds([&] { static_cast<void>(world.load(SnapshotKind::native, snapshot)); }));
    steps.push_back(microseconds([&] {
      for (int tick = 0; tick < options.ticks; ++tick)
        world.step();
    }));
    saves.push_back(
        microseconds([&] { static_cast<void>(world.save(SnapshotKind::native, scratch)); }));
    const std::uint64_t hash = world.hash().total;
    figures.repeated = figures.repeated && (i == 0 || hash == figures.hash);
    figures.hash = hash;
  }
  figures.save_us = median(saves);
  figures.load_us = median(loads);
  figures.resimulate_us = median(steps);
  return figures;
}

void print(const RollbackOptions& options, const Figures& f) {
  if (options.json) {
    const nlohmann::ordered_json json{{"bodies", f.bodies},
                                      {"contacts", f.contacts},
                                      {"snapshot_bytes", f.bytes},
                                      {"bytes_per_body", f.body_bytes},
                                      {"bytes_per_contact", f.contact_bytes},
                                      {"save_us", f.save_us},
                                      {"load_us", f.load_us},
                                      {"ticks", options.ticks},
                                      {"resimulate_us", f.resimulate_us},
                                      {"final_hash", hash_text(f.hash)}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{} bodies, {} touching pairs, medians of {}\n", f.bodies, f.contacts,
             options.repeats);
  fmt::print("snapshot     {:>9} bytes: {:.0f} a body, {:.0f} a touching pair, {} for all\n",
             f.bytes, f.body_bytes, f.contact_bytes, f.header_bytes);
  fmt::print("save         {:>9.1f} us\n", f.save_us);
  fmt::print("load         {:>9.1f} us\n", f.load_us);
  fmt::print("{} ticks anew {:>9.1f} us\n", options.ticks, f.resimulate_us);
  fmt::print("final hash   {}\n", hash_text(f.hash));
}

int run(const RollbackOptions& options) {
  const Figures figures = measure(options);
  print(options, figures);
  if (figures.repeated) return k_ok;
  complain("a tick simulated anew came to another hash");
  return k_different;
}

}  // namespace

void add_bench_rollback_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<RollbackOptions>();
  CLI::App* command = bench.add_subcommand("rollback", "Native snapshots and ticks simulated anew");
  command->add_option("--bodies", options->bodies, "Boxes in a pit")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
  command->add_option("--ticks", options->ticks, "Ticks to go back")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_option("--repeats", options->repeats, "Timed repeats")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  command->add_option("--settle", options->settle, "Ticks before")->capture_default_str();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
