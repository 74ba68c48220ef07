// A relay of UDP datagrams between clients and one server with the faults of bad networks.
// Everything is drawn from one seed; only the arrival of datagrams is not in its hands.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "net/transport/random.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::relay {

/// The faults that each datagram may suffer, in either direction. Chances in parts per million.
struct Faults {
  std::uint32_t loss_ppm = 0;       ///< of all datagrams, 0 … 900'000
  std::uint32_t burst_packets = 0;  ///< losses come in runs of this mean length, which end after
                                    ///< k_longest_burst_us; 0: independent
  std::uint32_t duplicate_ppm = 0;
  std::uint32_t reorder_ppm = 0;   ///< held back by up to 40 ms more
  std::uint32_t flip_ppm = 0;      ///< one bit is flipped
  std::uint32_t truncate_ppm = 0;  ///< cut short
  std::int64_t delay_us = 0;       ///< one way
  std::int64_t jitter_us = 0;      ///< the delay is uniform in delay ± jitter, at least 0
};

struct RelayCounters {
  std::uint64_t received = 0;
  std::uint64_t delivered = 0;
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t held_back = 0;
  std::uint64_t flipped = 0;
  std::uint64_t truncated = 0;
  std::uint64_t refused = 0;  ///< of more clients than the relay takes, or beyond its memory
};

class LossyRelay {
 public:
  static constexpr std::int64_t k_longest_burst_us = 200'000;
  static constexpr std::size_t k_max_clients = 64;
  static constexpr std::size_t k_max_waiting = 1 << 16;

  /// Listens on `local` and passes on to `server`, with one socket of its own for each client.
  [[nodiscard]] static Result<std::unique_ptr<LossyRelay>> open(const Endpoint& local,
                                                                const Endpoint& server,
                                                                const Faults& faults,
                                                                std::uint64_t seed);

  [[nodiscard]] std::uint16_t port() const { return front_->port(); }

  /// Receives arrived datagrams and forwards those that are due. Does not wait.
  void pump(std::int64_t now_us);

  /// Waits until something comes or is due, at most `limit_us`.
  void wait(std::int64_t now_us, std::int64_t limit_us) const;

  [[nodiscard]] const RelayCounters& counters() const { return counters_; }

 private:
  // One direction of one client.
  struct Way {
    explicit Way(std::uint64_t seed);
    net::Random loss, duplicate, reorder, delay, damage;
    bool in_burst = false;
    std::int64_t burst_began_us = 0;
  };

  struct Client {
    Client(const Endpoint& where, std::unique_ptr<UdpSocket> own, std::uint64_t seed)
        : endpoint(where), socket(std::move(own)), up(seed), down(seed + 1) {}
    Endpoint endpoint;
    std::unique_ptr<UdpSocket> socket;  ///< towards the server
    Way up, down;
  };

  struct Waiting {
    std::int64_t due_us;
    std::uint64_t sequence;
    std::size_t client;
    bool upwards;
    std::vector<std::byte> bytes;
    bool operator<(const Waiting& other) const {  // for a heap with the earliest on top
      return due_us != other.due_us ? due_us > other.due_us : sequence > other.sequence;
    }
  };

  LossyRelay(std::unique_ptr<UdpSocket> front, const Endpoint& server, const Faults& faults,
             std::uint64_t seed);
  [[nodiscard]] Client* client_of(const Endpoint& endpoint);
  void take(std::size_t client, bool upwards, ByteView bytes, std::int64_t now_us);
  [[nodiscard]] bool draw_loss(Way& way, std::int64_t now_us) const;
  [[nodiscard]] std::int64_t draw_delay_us(Way& way);
  void damage(Way& way, std::vector<std::byte>& bytes);
  void deliver(const Waiting& waiting);

  std::unique_ptr<UdpSocket> front_;
  Endpoint server_;
  Faults faults_;
  std::uint64_t seed_;
  std::uint64_t next_sequence_ = 0;
  std::vector<std::unique_ptr<Client>> clients_;
  std::vector<Waiting> waiting_;  ///< a heap
  RelayCounters counters_;
  std::array<std::byte, 65536> buffer_{};
};

}  // namespace lockstone::relay
