// A UDP socket over IPv4 that never blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::relay {

/// In host byte order.
struct Endpoint {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  friend bool operator==(const Endpoint&, const Endpoint&) = default;

  /// `127.0.0.1` and a port. malformed: another text.
  [[nodiscard]] static Result<Endpoint> from_text(const std::string& address, std::uint16_t port);
  [[nodiscard]] static Endpoint loopback(std::uint16_t port) { return {0x7f000001, port}; }
};

/// `127.0.0.1` of 0x7f000001.
[[nodiscard]] std::string to_text(std::uint32_t address);

class UdpSocket {
 public:
  /// Bound to this address; port 0: the system chooses. io_error: it refused.
  [[nodiscard]] static Result<std::unique_ptr<UdpSocket>> open(const Endpoint& local);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// False if the system did not take it, as a full network would.
  bool send(const Endpoint& to, ByteView bytes) const;

  /// The next datagram, in `buffer`; nothing if none waits.
  [[nodiscard]] std::optional<ByteView> receive(Endpoint& from, std::span<std::byte> buffer) const;

 private:
  explicit UdpSocket(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace lockstone::relay
