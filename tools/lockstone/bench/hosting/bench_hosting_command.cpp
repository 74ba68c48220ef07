// bench hosting: the cost of many matches in one process.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/App.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "tools/arena/arena_game.h"
#include "tools/bench/support/measure.h"
#include "tools/lockstone/bench/hosting/echo_simulation.h"
#include "tools/lockstone/bench/hosting/hosting_bots.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/rooms.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using namespace std::chrono_literals;

struct HostingOptions {
  unsigned matches = 200;
  unsigned bots = 4;
  unsigned seconds = 30;
  unsigned workers = 0;
  std::optional<std::uint32_t> bodies;
};

/// All that is counted, at one moment.
struct Moment {
  double seconds = 0;
  RoomsTime time;
  double bots = 0;  ///< processor time
  RoomsMetrics metrics;
};

double resident_kib() {
  long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    long all = 0;
    if (std::fscanf(file, "%ld %ld", &all, &pages) != 2) pages = 0;
    std::fclose(file);
  }
  return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1024;
}

// The arena, whose servers tell their hashes.
Games telling_arena(HashBoards& boards) {
  GameDef game = arena::arena_game();
  game.make = [&boards, make = game.make](ByteView config) -> Result<std::unique_ptr<Simulation>> {
    Result<std::unique_ptr<Simulation>> real = make(config);
    if (!real) return real.status();
    std::shared_ptr<HashBoard> board = boards.make(config, real.value()->info());
    return std::unique_ptr<Simulation>(
        std::make_unique<TellingSimulation>(std::move(real).value(), std::move(board)));
  };
  return Games({std::move(game)});
}

MatchOptions match_options(const HostingOptions& options, const net::Key& key) {
  MatchOptions match;
  match.start.players = options.bots;
  match.start.bodies = options.bodies;
  match.ticks = 0;
  match.key = key;
  match.match = 1;
  match.silent = true;
  return match;
}

/// The players, on a thread of their own.
class Crowd {
 public:
  Crowd(const HostingOptions& options, const net::Key& key, std::uint16_t port,
        const HashBoards& boards)
      : thread_([this, options, key, port, &boards] { run(options, key, port, boards); }) {}
  ~Crowd() {
    ends_ = true;
    thread_.join();
  }
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  [[nodiscard]] double seconds() const { return busy_seconds_; }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  void run(const HostingOptions& options, const net::Key& key, std::uint16_t port,
           const HashBoards& boards) {
    const Stopwatch watch;
    std::vector<std::unique_ptr<BotTeam>> teams;
    while (!ends_) {
      // A few at a time, as players come.
      for (unsigned i = 0; i < 2 && teams.size() < options.matches && !failed_; ++i) {
        teams.push_back(BotTeam::call(port, key, 1 + teams.size(), options.bots, boards));
        failed_ = teams.back() == nullptr;
      }
      if (failed_) return;
      for (const auto& team : teams)
        team->update(watch.microseconds());
      busy_seconds_ = static_cast<double>(bench::thread_nanoseconds()) * 1e-9;
      std::this_thread::sleep_for(4ms);
    }
  }

  std::atomic<bool> ends_{false};
  std::atomic<bool> failed_{false};
  std::atomic<double> busy_seconds_{0};
  std::thread thread_;
};

bool await(const std::function<bool()>& done, std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(50ms);
  }
  return true;
}

Moment look(const Rooms& rooms, const Crowd& crowd, const Stopwatch& watch) {
  return {watch.seconds(), rooms.time(), crowd.seconds(), rooms.metrics()};
}

void row(const char* name, const std::string& text) {
  fmt::print("{:<17} {}\n", name, text);
}

void print(const HostingOptions& options, const Moment& from, const Moment& to) {
  const double seconds = to.seconds - from.seconds;
  const double matches = options.matches;
  const auto percent = [seconds](double before, double after) {
    return 100 * (after - before) / seconds;
  };
  const auto rate = [seconds, matches](std::uint64_t before, std::uint64_t after) {
    return static_cast<double>(after - before) / seconds / matches;
  };
  const net::PlayerStats& before = from.metrics.sum.players.at(0);
  const net::PlayerStats& after = to.metrics.sum.players.at(0);
  const auto ticks = static_cast<double>(to.metrics.sum.ticks - from.metrics.sum.ticks);
  const double busy_ticks = std::max(ticks, 1.0);
  const double worker_us = 1e6 * (to.time.workers - from.time.workers) / busy_ticks;
  const double socket_us = 1e6 * (to.time.socket - from.time.socket) / busy_ticks;
  row("a tick", fmt::format("{:.0f} us of a core: {:.0f} workers, {:.0f} socket",
                            worker_us + socket_us, worker_us, socket_us));
  row("share of a core",
      fmt::format("{:.2f} % a match at 60 ticks a second", (worker_us + socket_us) * 60 / 1e4));
  row("in fact",
      fmt::format("{:.1f} ticks a second and match; {:.0f} % of a core workers, {:.0f} "
                  "socket, {:.0f} bots",
                  ticks / seconds / matches, percent(from.time.workers, to.time.workers),
                  percent(from.time.socket, to.time.socket), percent(from.bots, to.bots)));
  row("bandwidth",
      fmt::format("{:.1f} kB/s out, {:.1f} in a match; {:.0f} packets/s out, {:.0f} in",
                  rate(before.bytes_sent, after.bytes_sent) / 1000,
                  rate(before.bytes_received, after.bytes_received) / 1000,
                  rate(before.packets_sent, after.packets_sent),
                  rate(before.packets_received, after.packets_received)));
  row("inputs", fmt::format("{} late, {} replaced", after.late_inputs - before.late_inputs,
                            after.substituted_inputs - before.substituted_inputs));
  row("queues", fmt::format("{} packets lost, {} connections broken", to.metrics.router.lost,
                            to.metrics.router.broken));
  row("hashes", fmt::format("{} compared, {} equal", after.hashes_compared, after.hashes_equal));
}

std::string load_text() {
  std::array<double, 1> load{};
  if (::getloadavg(load.data(), 1) != 1) return "unknown";
  return fmt::format("{:.1f} on {} processors", load[0], std::thread::hardware_concurrency());
}

int bench_hosting(const HostingOptions& options) {
  if (!require_security()) return k_unavailable;
  net::SystemRandom random;
  const net::Key key = net::make_key(random);
  HashBoards boards;
  const Games games = telling_arena(boards);
  row("load before", load_text());
  const double memory_before = resident_kib();
  RoomsOptions wanted;
  wanted.rooms = options.matches;
  wanted.workers = options.workers;
  wanted.per_address_unlimited = true;
  const auto rooms = Rooms::open(games, match_options(options, key), wanted);
  if (rooms == nullptr) return k_unavailable;
  const auto open = [&] { return rooms->metrics().matches.size() == options.matches; };
  const auto running = [&] { return rooms->metrics().running == options.matches; };
  if (!await(open, 60s)) return k_unavailable;
  const double memory_open = resident_kib();
  const Stopwatch watch;
  auto crowd = std::make_unique<Crowd>(options, key, rooms->port(), boards);
  const bool all = await([&] { return crowd->failed() || running(); }, 120s) && !crowd->failed();
  if (!all) complain("not all matches have begun: the machine is too slow for so many");
  const double memory_running = resident_kib();
  rooms->restart_lateness();
  const Moment from = look(*rooms, *crowd, watch);
  std::this_thread::sleep_for(std::chrono::seconds(options.seconds));
  const Moment to = look(*rooms, *crowd, watch);
  const double memory_after = resident_kib();
  rooms->stop();
  const int code = rooms->finish();
  print(options, from, to);
  const TickLateness& late = rooms->lateness();
  const auto ms = [](std::int64_t us) { return static_cast<double>(us) / 1000; };
  row("late ticks", fmt::format("p50 {:.1f} ms, p99 {:.1f} ms, longest {:.1f} ms of {}",
                                ms(late.percentile_us(50)), ms(late.percentile_us(99)),
                                ms(late.longest_us()), late.ticks()));
  row("memory", fmt::format("{:.0f} KiB a match that waits; {:.0f} more while it runs, with its "
                            "bots; {:.0f} more in the time measured",
                            (memory_open - memory_before) / options.matches,
                            (memory_running - memory_open) / options.matches,
                            (memory_after - memory_running) / options.matches));
  row("load after", load_text());
  return all ? code : static_cast<int>(k_unavailable);
}

}  // namespace

void add_bench_hosting_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<HostingOptions>();
  CLI::App* command = bench.add_subcommand(
      "hosting", "Matches of the arena in one process, played by bots over loopback, encrypted");
  command->add_option("--matches", options->matches, "At once")
      ->check(CLI::Range(1U, 500U))
      ->capture_default_str();
  command->add_option("--bots", options->bots, "Players of a match, which do not simulate")
      ->check(CLI::Range(1U, 64U))
      ->capture_default_str();
  command->add_option("--bodies", options->bodies, "Loose bodies of the arena; default: as serve");
  command->add_option("--seconds", options->seconds, "Measured, once all matches run")
      ->check(CLI::Range(1U, 600U))
      ->capture_default_str();
  command->add_option("--workers", options->workers, "Threads that run the matches; as serve")
      ->check(CLI::Range(0U, 64U))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = bench_hosting(*options); });
}

}  // namespace lockstone::tool
