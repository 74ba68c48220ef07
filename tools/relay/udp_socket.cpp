#include "tools/relay/udp_socket.h"

#include <fcntl.h>
#include <unistd.h>

#include "tools/relay/system_address.h"

namespace lockstone::relay {

Result<Endpoint> Endpoint::from_text(const std::string& address, std::uint16_t port) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) return Status::malformed;
  return Endpoint{ntohl(parsed.s_addr), port};
}

std::string to_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    if (shift < 24) text += '.';
    text += std::to_string(address >> shift & 255);
  }
  return text;
}

Result<std::unique_ptr<UdpSocket>> UdpSocket::open(const Endpoint& local) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  if (descriptor < 0) return Status::io_error;
  auto result = std::unique_ptr<UdpSocket>(new UdpSocket(descriptor));
  constexpr int k_buffer_bytes = 1 << 20;
  setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &k_buffer_bytes, sizeof(k_buffer_bytes));
  const sockaddr_in address = to_system(local);
  const bool ready = fcntl(descriptor, F_SETFL, O_NONBLOCK) == 0 &&
                     bind(descriptor, generic(address), sizeof(address)) == 0;
  if (!ready) return Status::io_error;
  return result;
}

UdpSocket::~UdpSocket() {
  close(descriptor_);
}

std::uint16_t UdpSocket::port() const {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  if (getsockname(descriptor_, generic(address), &size) != 0) return 0;
  return from_system(address).port;
}

bool UdpSocket::send(const Endpoint& to, ByteView bytes) const {
  const sockaddr_in address = to_system(to);
  const ssize_t sent =
      sendto(descriptor_, bytes.data(), bytes.size(), 0, generic(address), sizeof(address));
  return sent == static_cast<ssize_t>(bytes.size());
}

std::optional<ByteView> UdpSocket::receive(Endpoint& from, std::span<std::byte> buffer) const {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  const ssize_t received =
      recvfrom(descriptor_, buffer.data(), buffer.size(), 0, generic(address), &size);
  if (received < 0) return std::nullopt;
  from = from_system(address);
  return ByteView(buffer).first(static_cast<std::size_t>(received));
}

}  // namespace lockstone::relay
