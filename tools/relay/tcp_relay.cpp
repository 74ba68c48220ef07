#include "tools/relay/tcp_relay.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <fcntl.h>
#include <netinet/tcp.h>
#include <unistd.h>

#include "tools/relay/system_address.h"

namespace lockstone::relay {
namespace {

constexpr std::size_t k_max_waiting_segments = 4096;
constexpr int k_backlog = 64;

void make_prompt(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::fcntl(socket, F_SETFL, O_NONBLOCK);
}

}  // namespace

Result<std::unique_ptr<TcpRelay>> TcpRelay::open(const Endpoint& local, const Endpoint& server,
                                                 const SegmentFaults& faults, std::uint64_t seed) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = to_system(local);
  const int on = 1;
  const bool ok = listener >= 0 &&
                  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
                  ::bind(listener, generic(address), sizeof address) == 0 &&
                  ::listen(listener, k_backlog) == 0 && ::fcntl(listener, F_SETFL, O_NONBLOCK) == 0;
  if (ok) return std::unique_ptr<TcpRelay>(new TcpRelay(listener, server, faults, seed));
  if (listener >= 0) ::close(listener);
  return Status::io_error;
}

TcpRelay::~TcpRelay() {
  ::close(listener_);
  for (const Way& way : ways_)
    ::close(way.from);
}

std::uint16_t TcpRelay::port() const {
  sockaddr_in address{};
  socklen_t bytes = sizeof address;
  ::getsockname(listener_, generic(address), &bytes);
  return from_system(address).port;
}

void TcpRelay::pump(std::int64_t now_us) {
  accept_callers();
  for (Way& way : ways_) {
    take(way, now_us);
    forward(way, now_us);
  }
}

// The server is on this machine or near it: connecting to it blocks for a moment.
void TcpRelay::accept_callers() {
  for (;;) {
    const int caller = ::accept(listener_, nullptr, nullptr);
    if (caller < 0) return;
    const int called = ::socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = to_system(server_);
    const bool ok = ways_.size() < 2 * k_max_connections && called >= 0 &&
                    ::connect(called, generic(address), sizeof address) == 0;
    if (!ok) {
      ::close(caller);
      if (called >= 0) ::close(called);
      continue;
    }
    make_prompt(caller);
    make_prompt(called);
    const std::uint64_t number = ++counters_.connections;
    ways_.push_back({caller, called, net::Random(seed_ + 2 * number), {}});
    ways_.push_back({called, caller, net::Random(seed_ + 2 * number + 1), {}});
  }
}

void TcpRelay::take(Way& way, std::int64_t now_us) {
  std::array<std::byte, k_segment_bytes> buffer;
  while (!way.ended && way.waiting.size() < k_max_waiting_segments) {
    const ssize_t size = ::recv(way.from, buffer.data(), buffer.size(), 0);
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    way.ended = size <= 0;
    enqueue(way, ByteView(buffer).first(static_cast<std::size_t>(std::max<ssize_t>(size, 0))),
            now_us);
  }
}

void TcpRelay::enqueue(Way& way, ByteView bytes, std::int64_t now_us) {
  const auto spread = static_cast<std::uint64_t>(2 * faults_.jitter_us + 1);
  const auto jitter_us = static_cast<std::int64_t>(way.random.below(spread)) - faults_.jitter_us;
  const std::int64_t repair_us = draw_repair_us(way);
  const std::int64_t own_us = now_us + std::max<std::int64_t>(0, faults_.delay_us + jitter_us);
  const std::int64_t due_us = std::max(way.last_due_us, own_us + repair_us);
  counters_.longest_us = std::max(counters_.longest_us, due_us - own_us);
  way.last_due_us = due_us;
  way.waiting.push_back({due_us, {bytes.begin(), bytes.end()}});
  ++counters_.segments;
}

std::int64_t TcpRelay::draw_repair_us(Way& way) {
  if (!way.random.chance(faults_.loss_ppm)) return 0;
  ++counters_.lost;
  std::int64_t repair_us = 2 * faults_.delay_us + k_three_segments_us;
  for (std::int64_t wait_us = k_time_out_us; way.random.chance(faults_.loss_ppm); wait_us *= 2)
    repair_us += wait_us + 2 * faults_.delay_us;
  return repair_us;
}

// A segment that the system does not take whole stays first.
void TcpRelay::forward(Way& way, std::int64_t now_us) {
  while (!way.waiting.empty() && way.waiting.front().due_us <= now_us) {
    std::vector<std::byte>& bytes = way.waiting.front().bytes;
    if (bytes.empty()) {
      ::shutdown(way.to, SHUT_WR);
    } else {
      const ssize_t sent = ::send(way.to, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      if (sent >= 0 && static_cast<std::size_t>(sent) < bytes.size()) {
        bytes.erase(bytes.begin(), bytes.begin() + sent);
        return;
      }
    }
    way.waiting.pop_front();
  }
}

}  // namespace lockstone::relay
