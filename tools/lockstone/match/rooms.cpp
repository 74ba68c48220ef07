#include "tools/lockstone/match/rooms.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <lockstone/net/match_router.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/agones.h"
#include "tools/lockstone/match/journal.h"
#include "tools/lockstone/match/match_socket.h"
#include "tools/lockstone/match/room.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using namespace std::chrono_literals;

constexpr auto k_socket_rest = 1ms;
constexpr auto k_worker_rest = 500us;
constexpr auto k_farewell = 200ms;  // for the last packets
constexpr std::int64_t k_longest_silence_us = 10'000'000;
constexpr std::int64_t k_counters_every_us = 100'000;
constexpr std::size_t k_strangers_a_room = 4;

// Of the calling thread, in seconds.
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

unsigned workers_of(const RoomsOptions& options) {
  if (options.workers != 0) return options.workers;
  return std::max(2U, std::thread::hardware_concurrency()) - 1;
}

}  // namespace

struct Rooms::Impl {
  /// A thread's sign of life.
  struct Pulse {
    std::atomic<std::int64_t> last_us{0};
    std::atomic<double> busy_seconds{0};
  };

  Impl(const Games& known, const MatchOptions& match, const RoomsOptions& given)
      : options(given),
        program(known, match, options),
        matches(*match.key, given.rooms),
        pulses(workers_of(given)) {}

  [[nodiscard]] bool open(const MatchOptions& match, std::size_t seats);
  void start();
  void run_socket();
  void run_worker(unsigned worker);
  [[nodiscard]] bool is_alive() const;

  RoomsOptions options;
  Stopwatch watch;
  RoomsProgram program;
  net::OpenMatches matches;
  std::unique_ptr<MatchSocket> socket;
  std::unique_ptr<net::MatchRouter> router;
  std::vector<std::unique_ptr<Room>> rooms;
  std::atomic<bool> workers_end{false};
  std::atomic<bool> socket_ends{false};
  Pulse socket_pulse;
  std::vector<Pulse> pulses;  ///< of the workers
  mutable std::mutex counters_mutex;
  RoomsMetrics counters;  ///< of the socket alone
  std::vector<std::thread> threads;
};

Rooms::Rooms(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Rooms::~Rooms() {
  if (impl_->threads.empty()) return;
  stop();
  static_cast<void>(finish());
}

std::unique_ptr<Rooms> Rooms::open(const Games& games, const MatchOptions& match,
                                   const RoomsOptions& options) {
  const std::optional<Match> first = start_match(games, match.start);
  if (!first) return nullptr;
  const std::size_t seats = first->simulation->info().player_count + match.spectators;
  auto impl = std::make_unique<Impl>(games, match, options);
  if (!impl->open(match, seats)) return nullptr;
  impl->start();
  return std::unique_ptr<Rooms>(new Rooms(std::move(impl)));
}

bool Rooms::Impl::open(const MatchOptions& match, std::size_t seats) {
  const std::size_t connections = options.rooms * (seats + k_strangers_a_room);
  if (connections > net::k_max_socket_connections) {
    complain(fmt::format("{} rooms of {} seats need {} connections; one socket has {}",
                         options.rooms, seats, connections, net::k_max_socket_connections));
    return false;
  }
  SocketOptions wanted;
  wanted.enet.bind_address = match.bind;
  wanted.enet.port = match.port;
  wanted.enet.max_connections = connections;
  wanted.enet.max_connections_per_address = match.max_per_address;
  if (options.per_address_unlimited) {
    wanted.enet.max_connections_per_address = connections;
    wanted.enet.max_strangers_per_address = connections;
  }
  wanted.web = match.web.options(wanted.enet);
  wanted.key = match.key;
  wanted.matches = &matches;
  wanted.addresses = match.addresses;
  wanted.unix_us_at_zero = unix_microseconds() - watch.microseconds();
  socket = MatchSocket::open(wanted);
  if (socket == nullptr) return false;
  net::MatchRouterOptions routing;
  routing.max_matches = options.rooms;
  routing.max_connections = std::min(connections * (wanted.web ? 2U : 1U),
                                     net::k_max_socket_connections);
  routing.max_connections_per_match = seats + k_strangers_a_room;
  auto made = net::MatchRouter::create(socket->session(), matches, routing);
  if (!made) {
    complain(fmt::format("no rooms: {}", to_string(made.status())));
    return false;
  }
  router = std::move(made).value();
  for (unsigned i = 0; i < options.rooms; ++i)
    rooms.push_back(std::make_unique<Room>(program, *router));
  return true;
}

void Rooms::Impl::start() {
  threads.emplace_back([this] { run_socket(); });
  for (unsigned worker = 0; worker < pulses.size(); ++worker)
    threads.emplace_back([this, worker] { run_worker(worker); });
}

// A fixed rest gathers datagrams: a round costs more than a datagram.
void Rooms::Impl::run_socket() {
  std::int64_t next_counters_us = 0;
  while (!socket_ends) {
    const std::int64_t now_us = watch.microseconds();
    router->pump(now_us);
    if (now_us >= next_counters_us) {
      next_counters_us = now_us + k_counters_every_us;
      socket_pulse.busy_seconds = processor_time();
      const std::lock_guard lock(counters_mutex);
      counters.sum.socket = socket->socket_counters();
      counters.sum.web = socket->web_counters();
      counters.sum.security = socket->security_counters();
      counters.router = router->counters();
    }
    socket_pulse.last_us = now_us;
    std::this_thread::sleep_for(k_socket_rest);
  }
}

// Each worker looks at all rooms, from a place of its own on, and passes those that another one is
// at: a slow match keeps one worker.
void Rooms::Impl::run_worker(unsigned worker) {
  const std::size_t first = worker * rooms.size() / pulses.size();
  while (!workers_end) {
    for (std::size_t i = 0; i < rooms.size(); ++i)
      rooms[(first + i) % rooms.size()]->try_work(watch);
    pulses[worker].last_us = watch.microseconds();
    pulses[worker].busy_seconds = processor_time();
    std::this_thread::sleep_for(k_worker_rest);
  }
}

bool Rooms::Impl::is_alive() const {
  const std::int64_t oldest_us = watch.microseconds() - k_longest_silence_us;
  return socket_pulse.last_us >= oldest_us &&
         std::any_of(pulses.begin(), pulses.end(),
                     [oldest_us](const Pulse& pulse) { return pulse.last_us >= oldest_us; });
}

bool Rooms::alive() const {
  return impl_->is_alive();
}

std::uint16_t Rooms::port() const {
  return impl_->socket->port();
}

const std::string& Rooms::web_address() const {
  return impl_->socket->web_address();
}

void Rooms::drain() {
  impl_->program.drain();
}

void Rooms::restart_lateness() {
  impl_->program.measure();
}

void Rooms::stop() {
  impl_->program.stop();
}

bool Rooms::over() const {
  return std::all_of(impl_->rooms.begin(), impl_->rooms.end(),
                     [](const auto& room) { return room->closed(); });
}

RoomsMetrics Rooms::metrics() const {
  RoomsMetrics metrics;
  {
    const std::lock_guard lock(impl_->counters_mutex);
    metrics = impl_->counters;
  }
  const EndedMatches ended = impl_->program.ended();
  metrics.ended = ended.count;
  metrics.ready = impl_->program.takes_more();
  metrics.state = metrics.ready ? "open" : "draining";
  metrics.alive = alive();
  add_up(metrics.sum, ended.sum);
  for (const auto& room : impl_->rooms) {
    std::optional<MatchMetrics> match = room->metrics();
    if (!match) continue;
    add_up_present(metrics.sum, *match);
    if (match->state != to_string(net::ServerState::lobby)) ++metrics.running;
    metrics.matches.push_back(std::move(*match));
  }
  return metrics;
}

RoomsTime Rooms::time() const {
  RoomsTime time{impl_->socket_pulse.busy_seconds, 0};
  for (const auto& pulse : impl_->pulses)
    time.workers += pulse.busy_seconds;
  return time;
}

int Rooms::finish() {
  Impl& impl = *impl_;
  while (!over())
    std::this_thread::sleep_for(1ms);
  impl.workers_end = true;
  std::this_thread::sleep_for(k_farewell);
  impl.socket_ends = true;
  for (std::thread& thread : impl.threads)
    thread.join();
  impl.threads.clear();
  return impl.program.ended().code;
}

const TickLateness& Rooms::lateness() const {
  return impl_->program.lateness();
}

}  // namespace lockstone::tool
