// Agones: tells the sidecar of a game server in a Kubernetes fleet how the server is.
//
// Calls and order: https://agones.dev/site/docs/guides/client-sdks/rest/
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace lockstone::tool {

/// Posts `/ready`, `/allocate` and `/shutdown` in the order of the calls here, each until the
/// sidecar has taken it, and `/health` every two seconds in between. A thread of its own does it:
/// no call waits but `shutdown`. Any thread may call.
class Agones {
 public:
  /// The sidecar's port is in the environment, AGONES_SDK_HTTP_PORT; else 9358. Null, with a
  /// complaint, when that is no port.
  [[nodiscard]] static std::unique_ptr<Agones> from_environment();
  ~Agones();
  Agones(const Agones&) = delete;
  Agones& operator=(const Agones&) = delete;

  /// The server listens.
  void ready();

  /// The server's loop runs: without a call for five seconds there is no `/health`.
  void beat();

  /// The first of the running matches allocates the server. After the last one it is ready again if
  /// it takes more.
  void match_began();
  void match_ended(bool takes_more);

  /// The server ends: waits until the sidecar knows, at most five seconds.
  void shutdown();

 private:
  using Clock = std::chrono::steady_clock;

  explicit Agones(std::uint16_t port);
  void run();
  void order(const char* path);
  [[nodiscard]] bool post(const char* path) const;
  void post_next(std::unique_lock<std::mutex>& lock);

  std::uint16_t port_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<const char*> orders_;
  unsigned running_ = 0;  ///< matches
  bool healthy_ = false;  ///< between the first `/ready` and `/shutdown`
  bool complained_ = false;
  bool ends_ = false;
  Clock::time_point next_try_;
  Clock::time_point next_health_;
  Clock::time_point last_beat_;
  std::thread thread_;
};

}  // namespace lockstone::tool
