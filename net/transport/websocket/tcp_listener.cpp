#include "net/transport/websocket/tcp_listener.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "net/transport/udp/system_address.h"

namespace lockstone::net {
namespace {

constexpr int k_backlog = 64;
constexpr int k_unsent_bytes = 16 * 1024;

DatagramSource source_of_caller(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, &address, sizeof ipv4);
    std::array<std::byte, 4> bytes{};
    std::memcpy(bytes.data(), &ipv4.sin_addr, bytes.size());
    return {.address = map_ipv4(bytes), .port = ntohs(ipv4.sin_port)};
  }
  sockaddr_in6 ipv6{};
  std::memcpy(&ipv6, &address, sizeof ipv6);
  return from_system(ipv6);
}

bool prepare(int socket, const addrinfo& where) {
  const int on = 1;
  const int off = 0;
  if (socket < 0) return false;
  if (where.ai_family == AF_INET6)
    ::setsockopt(socket, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  return ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
         ::bind(socket, where.ai_addr, where.ai_addrlen) == 0 && ::listen(socket, k_backlog) == 0 &&
         ::fcntl(socket, F_SETFL, O_NONBLOCK) == 0 && ::fcntl(socket, F_SETFD, FD_CLOEXEC) == 0;
}

}  // namespace

std::unique_ptr<TcpListener> TcpListener::open(const std::string& address, std::uint16_t port,
                                               std::string& problem) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    problem = "not a numeric address";
    return nullptr;
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  const int socket = ::socket(found->ai_family, SOCK_STREAM, 0);
  if (prepare(socket, *found)) return std::unique_ptr<TcpListener>(new TcpListener(socket));
  problem = std::strerror(errno);
  if (socket >= 0) ::close(socket);
  return nullptr;
}

TcpListener::~TcpListener() {
  ::close(socket_);
}

std::uint16_t TcpListener::port() const {
  sockaddr_storage address{};
  socklen_t bytes = sizeof address;
  ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &bytes);
  return source_of_caller(address).port;
}

std::optional<TcpListener::Caller> TcpListener::accept() const {
  sockaddr_storage address{};
  socklen_t bytes = sizeof address;
  const int socket = ::accept(socket_, reinterpret_cast<sockaddr*>(&address), &bytes);
  if (socket < 0) return std::nullopt;
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  return Caller{socket, source_of_caller(address)};
}

void TcpListener::turn_away(const Caller& caller) {
  ::close(caller.socket);
}

void keep_system_queue_short(int socket) {
#ifdef TCP_NOTSENT_LOWAT
  ::setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &k_unsent_bytes, sizeof k_unsent_bytes);
#endif
}

void hold_segments(int socket, bool held) {
#ifdef TCP_CORK
  const int value = held ? 1 : 0;
  ::setsockopt(socket, IPPROTO_TCP, TCP_CORK, &value, sizeof value);
#endif
}

}  // namespace lockstone::net
