// The inside of EnetTransport: ENet, the gate in front of it, and the translation of its events.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_connections.h"
#include "net/transport/enet/enet_data.h"
#include "net/transport/enet/enet_gate.h"
#include "net/transport/enet/enet_outgoing.h"
#include "net/transport/enet/enet_refusals.h"

namespace lockstone::net {

/// Owns ENet's host, is called by it for every datagram, and turns its events into the session's.
struct EnetTransport::State {
  explicit State(const EnetOptions& options);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // enet_setup.cpp
  static Result<std::unique_ptr<State>> create(const EnetOptions& options,
                                               const ENetAddress* address,
                                               std::string* problem = nullptr);
  static Result<std::unique_ptr<State>> listen(const EnetOptions& options, std::string* problem);

  /// The next event of the session; false: there is none.
  [[nodiscard]] bool poll(std::int64_t now_us, TransportEvent& event);

  [[nodiscard]] std::uint16_t port() const;

  /// Opens the IPv6 side, if there is none. The reason for a failure is in errno.
  [[nodiscard]] bool add_ipv6(const DatagramSource* local);

  EnetData data;
  EnetConnections connections;
  EnetRefusals refusals;
  EnetGate gate;
  EnetOutgoing outgoing;

 private:
  // enet_setup.cpp: ENet's callbacks.
  static State& of(const ENetHost* host);
  static int ENET_CALLBACK intercept(ENetHost* host, ENetEvent*);
  static enet_uint32 ENET_CALLBACK compute_checksum(const ENetBuffer* buffers, std::size_t count);
  void configure(const EnetOptions& options);
  static Result<std::unique_ptr<State>> create_ipv6(const EnetOptions& options,
                                                    const DatagramSource& local,
                                                    std::string* problem);

  void release_current();
  [[nodiscard]] bool translate(const ENetEvent& from, TransportEvent& event);
  [[nodiscard]] bool was_cut_short() const;
  [[nodiscard]] bool admit_ipv6();

  ENetPacket* current_ = nullptr;   ///< the last event's bytes point into it
  unsigned datagrams_a_round_ = 0;  ///< that ENet has taken
  bool takes_ipv4_ = true;          ///< false: bound to an IPv6 address
};

}  // namespace lockstone::net
