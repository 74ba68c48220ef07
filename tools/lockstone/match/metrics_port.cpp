#include "tools/lockstone/match/metrics_port.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

constexpr std::size_t k_longest_request = 4096;

bool would_block() {
  return errno == EAGAIN || errno == EWOULDBLOCK;
}

}  // namespace

std::unique_ptr<MetricsPort> MetricsPort::open(std::uint16_t port, const std::string& address) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    complain(fmt::format("no metrics: {} is no numeric address", address));
    return nullptr;
  }
  const int socket = ::socket(found->ai_family, SOCK_STREAM, 0);
  const int yes = 1;
  const bool ok = socket >= 0 &&
                  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                  ::bind(socket, found->ai_addr, found->ai_addrlen) == 0 &&
                  ::listen(socket, 4) == 0 && ::fcntl(socket, F_SETFL, O_NONBLOCK) == 0;
  const int error = errno;
  ::freeaddrinfo(found);
  if (ok) return std::unique_ptr<MetricsPort>(new MetricsPort(socket));
  complain(fmt::format("no metrics on {} port {}: {}", address, port, std::strerror(error)));
  if (socket >= 0) ::close(socket);
  return nullptr;
}

// The port is in the same place for both families.
std::uint16_t MetricsPort::port() const {
  sockaddr_storage address{};
  socklen_t bytes = sizeof address;
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &bytes);
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

MetricsPort::~MetricsPort() {
  leave();
  ::close(socket_);
}

void MetricsPort::serve(const Answerer& answerer) {
  admit_next();
  if (client_ >= 0 && answer_.empty()) read(answerer);
  if (client_ >= 0 && !answer_.empty()) write();
}

// The next in line shall not wait for one who says nothing, or does not read.
void MetricsPort::admit_next() {
  const int next = ::accept(socket_, nullptr, nullptr);
  if (next < 0) return;
  leave();
  client_ = next;
  ::fcntl(client_, F_SETFL, O_NONBLOCK);
}

void MetricsPort::read(const Answerer& answerer) {
  std::array<char, 1024> bytes{};
  const ssize_t count = ::recv(client_, bytes.data(), bytes.size(), 0);
  if (count < 0 && would_block()) return;
  if (count <= 0) return leave();
  request_.append(bytes.data(), static_cast<std::size_t>(count));
  if (request_.find("\r\n\r\n") == std::string::npos) {
    if (request_.size() > k_longest_request) leave();
    return;
  }
  const HttpAnswer answer = answerer(request_);
  answer_ = fmt::format(
      "HTTP/1.0 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}",
      answer.status, answer.type, answer.body.size(), answer.body);
}

void MetricsPort::write() {
  const ssize_t count =
      ::send(client_, answer_.data() + sent_, answer_.size() - sent_, MSG_NOSIGNAL);
  if (count < 0 && would_block()) return;
  if (count <= 0) return leave();
  sent_ += static_cast<std::size_t>(count);
  if (sent_ == answer_.size()) leave();
}

void MetricsPort::leave() {
  if (client_ >= 0) ::close(client_);
  client_ = -1;
  sent_ = 0;
  request_.clear();
  answer_.clear();
}

}  // namespace lockstone::tool
