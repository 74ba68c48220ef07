// A listening TCP socket that never blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "net/transport/udp/datagram_source.h"

namespace lockstone::net {

class TcpListener {
 public:
  struct Caller {
    int socket = -1;  ///< the receiver closes it
    DatagramSource source;
  };

  /// At a numeric address; at `::` for IPv4 too. Null, with a line for people in `problem`, when
  /// the system refuses.
  [[nodiscard]] static std::unique_ptr<TcpListener> open(const std::string& address,
                                                         std::uint16_t port, std::string& problem);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// The next one who has called, if any.
  [[nodiscard]] std::optional<Caller> accept() const;

  /// Closes the connection at once, without a word.
  static void turn_away(const Caller& caller);

 private:
  explicit TcpListener(int socket) : socket_(socket) {}

  int socket_;
};

/// Keeps bytes that wait in the transport, where newer packets may replace them, instead of in the
/// system.
void keep_system_queue_short(int socket);

/// While held, the system puts small writes together into full segments: fewer of them can be lost.
void hold_segments(int socket, bool held);

}  // namespace lockstone::net
