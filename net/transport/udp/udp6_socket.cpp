#include "net/transport/udp/udp6_socket.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "net/transport/udp/system_address.h"

namespace lockstone::net {
namespace {

sockaddr_in6 to_system(const DatagramSource& source) {
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  address.sin6_port = htons(source.port);
  address.sin6_scope_id = source.scope;
  std::memcpy(&address.sin6_addr, source.address.data(), source.address.size());
  return address;
}

const sockaddr* generic(const sockaddr_in6& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}
sockaddr* generic(sockaddr_in6& address) {
  return reinterpret_cast<sockaddr*>(&address);
}

#ifdef _WIN32
bool was_too_long() {
  return WSAGetLastError() == WSAEMSGSIZE;
}
void tell_called_address(ENetSocket) {}  // answers go from where the system chooses

void send_datagram(ENetSocket socket, const DatagramSource& to, ByteView bytes) {
  const sockaddr_in6 address = to_system(to);
  const auto* begin = reinterpret_cast<const char*>(bytes.data());
  sendto(socket, begin, static_cast<int>(bytes.size()), 0, generic(address), sizeof(address));
}

std::optional<std::size_t> receive_datagram(ENetSocket socket, DatagramSource& from,
                                            std::span<std::byte> buffer) {
  sockaddr_in6 address{};
  socklen_t size = sizeof(address);
  auto* begin = reinterpret_cast<char*>(buffer.data());
  const int received =
      recvfrom(socket, begin, static_cast<int>(buffer.size()), 0, generic(address), &size);
  if (received < 0 && !was_too_long()) return std::nullopt;
  from = from_system(address);
  return received < 0 ? buffer.size() : static_cast<std::size_t>(received);
}

int wait_for(std::span<pollfd> sockets, int limit_ms) {
  return WSAPoll(sockets.data(), static_cast<ULONG>(sockets.size()), limit_ms);
}
#else
bool was_too_long() {
  return false;  // cut off without an error
}

void tell_called_address(ENetSocket socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_IPV6, IPV6_RECVPKTINFO, &on, sizeof(on));
}

// One message with room for the address of this host (RFC 3542, section 6).
class Message {
 public:
  Message(sockaddr_in6& address, void* bytes, std::size_t size) : part_{bytes, size} {
    header_.msg_name = &address;
    header_.msg_namelen = sizeof(address);
    header_.msg_iov = &part_;
    header_.msg_iovlen = 1;
  }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;

  [[nodiscard]] std::optional<std::size_t> receive(ENetSocket socket) {
    header_.msg_control = control_.data();
    header_.msg_controllen = control_.size();
    const ssize_t size = recvmsg(socket, &header_, 0);
    if (size < 0) return std::nullopt;
    return static_cast<std::size_t>(size);
  }

  void send(ENetSocket socket) { static_cast<void>(sendmsg(socket, &header_, MSG_NOSIGNAL)); }

  void send_from(const Ipv6Bytes& own) {
    header_.msg_control = control_.data();
    header_.msg_controllen = control_.size();
    cmsghdr* control = CMSG_FIRSTHDR(&header_);
    control->cmsg_level = IPPROTO_IPV6;
    control->cmsg_type = IPV6_PKTINFO;
    control->cmsg_len = CMSG_LEN(sizeof(in6_pktinfo));
    in6_pktinfo info{};
    std::memcpy(&info.ipi6_addr, own.data(), own.size());
    std::memcpy(CMSG_DATA(control), &info, sizeof(info));
  }

  /// Zeros if the system does not say.
  [[nodiscard]] Ipv6Bytes called() {
    Ipv6Bytes own{};
    for (cmsghdr* control = CMSG_FIRSTHDR(&header_); control != nullptr;
         control = CMSG_NXTHDR(&header_, control)) {
      if (control->cmsg_level != IPPROTO_IPV6 || control->cmsg_type != IPV6_PKTINFO) continue;
      in6_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(control), sizeof(info));
      std::memcpy(own.data(), &info.ipi6_addr, own.size());
    }
    return own;
  }

 private:
  iovec part_;
  msghdr header_{};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(in6_pktinfo))> control_{};
};

void send_datagram(ENetSocket socket, const DatagramSource& to, ByteView bytes) {
  sockaddr_in6 address = to_system(to);
  Message message(address, const_cast<std::byte*>(bytes.data()), bytes.size());
  if (to.called != Ipv6Bytes{}) message.send_from(to.called);
  message.send(socket);
}

std::optional<std::size_t> receive_datagram(ENetSocket socket, DatagramSource& from,
                                            std::span<std::byte> buffer) {
  sockaddr_in6 address{};
  Message message(address, buffer.data(), buffer.size());
  const std::optional<std::size_t> size = message.receive(socket);
  if (!size) return std::nullopt;
  from = from_system(address);
  from.called = message.called();
  return size;
}

int wait_for(std::span<pollfd> sockets, int limit_ms) {
  return poll(sockets.data(), sockets.size(), limit_ms);
}
#endif

}  // namespace

std::optional<DatagramSource> read_ipv6(const std::string& address, std::uint16_t port) {
  const SocketLibrary library;
  addrinfo hints{};
  hints.ai_family = AF_INET6;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICHOST;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.c_str(), nullptr, &hints, &found) != 0) return std::nullopt;
  sockaddr_in6 first{};
  std::memcpy(&first, found->ai_addr, sizeof(first));
  freeaddrinfo(found);
  DatagramSource source = from_system(first);
  source.port = port;
  return source;
}

std::unique_ptr<Udp6Socket> Udp6Socket::open(const DatagramSource* local) {
  const ENetSocket handle = socket(AF_INET6, SOCK_DGRAM, 0);
  if (handle == ENET_SOCKET_NULL) return nullptr;
  auto result = std::unique_ptr<Udp6Socket>(new Udp6Socket(handle));
  const int only = 1;
  const auto* option = reinterpret_cast<const char*>(&only);
  if (setsockopt(handle, IPPROTO_IPV6, IPV6_V6ONLY, option, sizeof(only)) != 0) return nullptr;
  if (enet_socket_set_option(handle, ENET_SOCKOPT_NONBLOCK, 1) != 0) return nullptr;
  // As large as those of ENet's socket; a smaller one will do.
  enet_socket_set_option(handle, ENET_SOCKOPT_RCVBUF, ENET_HOST_RECEIVE_BUFFER_SIZE);
  enet_socket_set_option(handle, ENET_SOCKOPT_SNDBUF, ENET_HOST_SEND_BUFFER_SIZE);
  if (local == nullptr) return result;
  tell_called_address(handle);
  const sockaddr_in6 address = to_system(*local);
  if (bind(handle, generic(address), sizeof(address)) == 0) return result;
  const int reason = errno;
  result.reset();
  errno = reason;
  return nullptr;
}

Udp6Socket::~Udp6Socket() {
  enet_socket_destroy(socket_);
}

std::uint16_t Udp6Socket::port() const {
  sockaddr_in6 address{};
  socklen_t size = sizeof(address);
  if (getsockname(socket_, generic(address), &size) != 0) return 0;
  return from_system(address).port;
}

void Udp6Socket::send(const DatagramSource& to, ByteView bytes) const {
  send_datagram(socket_, to, bytes);
}

std::optional<std::size_t> Udp6Socket::receive(DatagramSource& from,
                                               std::span<std::byte> buffer) const {
  return receive_datagram(socket_, from, buffer);
}

bool waits_behind(ENetSocket socket, const ENetAddress& own) {
  for (;;) {
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    char byte = 0;
    const auto read = [&](int flags) {
      auto* address = reinterpret_cast<sockaddr*>(&from);
      return recvfrom(socket, &byte, 1, flags, address, &size) >= 0 || was_too_long();
    };
    if (!read(MSG_PEEK)) return false;
    if (from.sin_addr.s_addr != own.host || ntohs(from.sin_port) != own.port) return true;
    static_cast<void>(read(0));
  }
}

bool wait_for_either(ENetSocket a, ENetSocket b, enet_uint32 limit_ms) {
  std::array<pollfd, 2> sockets{};
  sockets[0].fd = a;
  sockets[1].fd = b;
  for (pollfd& socket : sockets)
    socket.events = POLLIN;
  return wait_for(sockets, static_cast<int>(limit_ms)) > 0 &&
         ((sockets[0].revents | sockets[1].revents) & POLLIN) != 0;
}

}  // namespace lockstone::net
