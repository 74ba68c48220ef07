// A client whose datagrams pass through its owner's hands: it calls from any address of this
// machine, and may send datagrams that ENet never would.
#pragma once

#include <memory>
#include <optional>

#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>

#include "net/transport/enet/enet_datagram.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::relay {

class Intruder {
 public:
  enum class Conduct : std::uint8_t {
    silent,    ///< connects under the link key and says nothing
    half_way,  ///< shows its token, and never proves that it has the keys
    all_the_way
  };

  /// Calls `server` from `address`. Null: the system refuses a socket.
  [[nodiscard]] static std::unique_ptr<Intruder> call(std::uint32_t address, const Endpoint& server,
                                                      const net::ConnectToken& token,
                                                      Conduct conduct);
  ~Intruder();

  /// Forwards the datagrams that have arrived.
  void pump();
  /// Takes the events of its transport: for one that no session polls.
  void poll(std::int64_t now_us);

  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] std::uint64_t answers() const { return answers_; }

  /// Sends commands in a datagram of this connection. From the first on, none of ENet's own follow.
  void inject(ByteView commands);

  [[nodiscard]] net::Transport& transport();
  [[nodiscard]] net::ConnectionId connection() const { return connection_; }

 private:
  class Tap;

  Intruder(const Endpoint& server, const net::LinkKey& link_key);
  [[nodiscard]] bool open(std::uint32_t address, const net::ConnectToken& token, Conduct conduct);

  Endpoint server_;
  net::LinkChecksum checksum_;
  net::SystemRandom random_;
  std::unique_ptr<UdpSocket> socket_;
  std::unique_ptr<net::EnetTransport> enet_;
  std::unique_ptr<Tap> tap_;
  std::unique_ptr<net::SecureTransport> secure_;
  net::ConnectionId connection_ = net::k_no_connection;
  Endpoint client_;
  net::Word id_{};                         ///< of the connection
  std::array<std::byte, 2> head_{};        ///< of the client's last datagram
  std::optional<net::DatagramSeal> seal_;  ///< of injected datagrams
  std::uint64_t answers_ = 0;
  bool asked_ = false;
  bool connected_ = false;
  bool ended_ = false;
  bool injected_ = false;
};

}  // namespace lockstone::relay
