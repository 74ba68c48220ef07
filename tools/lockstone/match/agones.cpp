#include "tools/lockstone/match/agones.h"

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t k_usual_port = 9358;
constexpr auto k_health_period = 2s;
constexpr auto k_longest_silence = 5s;
constexpr auto k_retry = 1s;
constexpr auto k_patience_at_end = 5s;

/// A blocking TCP connection to this machine, with time-outs.
class LocalSocket {
 public:
  explicit LocalSocket(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval limit{2, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    open_ = socket_ >= 0 &&
            ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~LocalSocket() {
    if (socket_ >= 0) ::close(socket_);
  }
  LocalSocket(const LocalSocket&) = delete;
  LocalSocket& operator=(const LocalSocket&) = delete;

  [[nodiscard]] bool send(std::string_view text) const {
    return open_ && ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) ==
                        static_cast<ssize_t>(text.size());
  }

  /// All that comes until the other side closes, or until the time-out.
  [[nodiscard]] std::string receive() const {
    std::string text;
    std::array<char, 1024> bytes{};
    constexpr std::size_t k_longest = 16'384;
    while (text.size() < k_longest) {
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count <= 0) break;
      text.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int socket_;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<Agones> Agones::from_environment() {
  std::uint16_t port = k_usual_port;
  if (const char* text = std::getenv("AGONES_SDK_HTTP_PORT"); text != nullptr && *text != '\0') {
    char* end = nullptr;
    const unsigned long value = std::strtoul(text, &end, 10);
    if (*end != '\0' || value < 1 || value > 65535) {
      complain(fmt::format("AGONES_SDK_HTTP_PORT is {}; it must be 1 … 65535", text));
      return nullptr;
    }
    port = static_cast<std::uint16_t>(value);
  }
  return std::unique_ptr<Agones>(new Agones(port));
}

Agones::Agones(std::uint16_t port) : port_(port), last_beat_(Clock::now()) {
  thread_ = std::thread([this] { run(); });
}

Agones::~Agones() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Agones::ready() {
  order("/ready");
}

void Agones::beat() {
  const std::lock_guard lock(mutex_);
  last_beat_ = Clock::now();
}

void Agones::match_began() {
  {
    const std::lock_guard lock(mutex_);
    if (running_++ != 0) return;
  }
  order("/allocate");
}

void Agones::match_ended(bool takes_more) {
  {
    const std::lock_guard lock(mutex_);
    if (--running_ != 0) return;
  }
  if (takes_more) order("/ready");
}

void Agones::shutdown() {
  order("/shutdown");
  std::unique_lock lock(mutex_);
  static_cast<void>(changed_.wait_for(lock, k_patience_at_end, [this] { return orders_.empty(); }));
}

void Agones::order(const char* path) {
  {
    const std::lock_guard lock(mutex_);
    orders_.push_back(path);
  }
  changed_.notify_all();
}

void Agones::run() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    const Clock::time_point now = Clock::now();
    if (!orders_.empty() && now >= next_try_) {
      post_next(lock);
      continue;
    }
    const bool healthy = healthy_ && now - last_beat_ < k_longest_silence;
    if (healthy && now >= next_health_ && orders_.empty()) {
      next_health_ = now + k_health_period;
      lock.unlock();
      static_cast<void>(post("/health"));
      lock.lock();
      continue;
    }
    changed_.wait_for(lock, 100ms);
  }
}

// The sidecar may start later than the server: a call is made again until it succeeds.
void Agones::post_next(std::unique_lock<std::mutex>& lock) {
  const char* path = orders_.front();
  lock.unlock();
  const bool taken = post(path);
  if (!taken && !complained_) {
    complain(fmt::format("Agones' sidecar does not take {} on port {}; trying on", path, port_));
    complained_ = true;
  }
  lock.lock();
  if (taken) {
    orders_.pop_front();
    healthy_ = std::string_view(path) != "/shutdown";
    changed_.notify_all();
  } else {
    next_try_ = Clock::now() + k_retry;
  }
}

bool Agones::post(const char* path) const {
  const LocalSocket socket(port_);
  const std::string request = fmt::format(
      "POST {} HTTP/1.1\r\nHost: localhost:{}\r\nContent-Type: application/json\r\n"
      "Content-Length: 2\r\nConnection: close\r\n\r\n{{}}",
      path, port_);
  if (!socket.send(request)) return false;
  const std::string answer = socket.receive();
  const std::size_t status = answer.find(' ');
  return answer.starts_with("HTTP/1.") && answer.compare(status + 1, 3, "200") == 0;
}

}  // namespace lockstone::tool
