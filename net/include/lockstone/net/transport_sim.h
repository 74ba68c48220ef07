// A network in one process, in virtual time, drawn from one seed: the same calls give the same
// packets at the same microsecond, on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net {

/// Faults that a link adds to its packets. Probabilities are in parts per million (0 … 1'000'000).
/// Each fault draws from its own random stream: switching one on leaves the others' draws as they
/// were.
struct LinkFaults {
  std::uint32_t loss_ppm = 0;         ///< independent loss
  std::uint32_t burst_start_ppm = 0;  ///< chance that a packet begins a burst, which loses packets
  std::uint32_t burst_end_ppm = 250'000;  ///< chance that a burst ends after a packet: mean of four
  std::uint32_t duplicate_ppm = 0;        ///< delivered twice, each with its own delay
  std::uint32_t reorder_ppm = 0;          ///< held back by up to reorder_us
  std::uint32_t corrupt_ppm = 0;          ///< one byte of an unreliable packet is changed
  std::uint32_t truncate_ppm = 0;         ///< an unreliable packet is cut short
  std::int64_t delay_us = 0;              ///< one way, 0 … 10 s
  std::int64_t jitter_us = 0;             ///< added to the delay, uniform in 0 … jitter_us
  std::int64_t reorder_us = 40'000;
};

/// The traffic in flight, to all endpoints together.
struct SimTraffic {
  std::size_t packets = 0;
  std::size_t bytes = 0;
  std::size_t peak_bytes = 0;
};

class SimTransport;

/// Which way an endpoint is cut off.
enum class Cut : std::uint8_t { both, sending, receiving };
[[nodiscard]] std::string_view to_string(Cut cut);

/// Owns the endpoints and the packets in flight. One thread.
class SimNetwork {
 public:
  explicit SimNetwork(std::uint64_t seed);
  ~SimNetwork();
  SimNetwork(const SimNetwork&) = delete;
  SimNetwork& operator=(const SimNetwork&) = delete;

  /// A new endpoint; lives as long as the network.
  SimTransport& add_endpoint();

  /// Connects two endpoints; both get `connected` after the link's delay, counted from the first
  /// poll. Returns `from`'s connection. `faults` holds for both directions.
  ConnectionId connect(SimTransport& from, SimTransport& to, const LinkFaults& faults);

  /// Changes every link of an endpoint, one way or both, for packets sent from now on.
  void set_faults(const SimTransport& endpoint, const LinkFaults& faults, Cut way = Cut::both);

  /// From now on this is the network's time, whatever clocks the endpoints go by. Never runs
  /// backwards. Without a call, the network believes each endpoint's own clock.
  void set_time(std::int64_t now_us);

  /// An endpoint dies without a word: the packets in flight to it are lost, and all that follow.
  void kill(SimTransport& endpoint);

  /// Somebody sends a packet that seems to come from the peer of one of `receiver`'s connections.
  void forge(SimTransport& receiver, ConnectionId connection, ByteView bytes);

  [[nodiscard]] SimTraffic traffic() const;

  /// Cuts an endpoint off for packets sent in from_us ≤ t < until_us: unreliable ones are lost,
  /// reliable ones wait for the end. Both times are in 0 … 2^62.
  void partition(const SimTransport& endpoint, std::int64_t from_us, std::int64_t until_us,
                 Cut cut = Cut::both);

 private:
  friend class SimTransport;
  struct State;
  std::unique_ptr<State> state_;
};

/// One endpoint of a SimNetwork.
class SimTransport final : public Transport {
 public:
  ~SimTransport() override;
  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override {}
  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;

 private:
  friend class SimNetwork;
  struct Packet;
  struct Link;
  struct Window {
    std::int64_t from_us;
    std::int64_t until_us;
    Cut cut;
  };
  SimTransport(SimNetwork& network, std::size_t index);
  [[nodiscard]] Link* find(ConnectionId connection) const;
  [[nodiscard]] std::int64_t after_partitions(const Link& link, std::int64_t sent_us) const;
  [[nodiscard]] const Window* cut_off(std::int64_t at_us, Cut way) const;
  void send_reliable(Link& link, Packet packet);
  void send_unreliable(Link& link, const Packet& packet);
  void damage(Link& link, Packet& packet) const;
  void deliver(Packet packet);
  [[nodiscard]] std::int64_t network_time() const;

  SimNetwork& network_;
  std::size_t index_;
  std::int64_t now_us_ = 0;
  bool dead_ = false;
  std::vector<std::unique_ptr<Link>> links_;  ///< connection id - 1
  std::vector<Packet> arriving_;              ///< heap, earliest first
  std::unique_ptr<Packet> current_;           ///< the last event's bytes point into it
  std::vector<Window> partitions_;
};

}  // namespace lockstone::net
