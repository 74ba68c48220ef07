// One client of a simulated match, with its faulty machine: clock, pauses, deaths.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <lockstone/net/client.h>
#include <lockstone/net/transport_sim.h>

#include "tools/simnet/lying_transport.h"
#include "tools/simnet/oracle.h"
#include "tools/simnet/schedule.h"
#include "tools/simnet/sealed_transport.h"

namespace lockstone::simnet {

/// A clock that runs up to 500 ppm fast or slow, and never backwards.
class SkewedClock {
 public:
  void advance(std::int64_t span_us, std::int64_t skew_ppm) {
    local_ns_ += span_us * 1000 + span_us * skew_ppm / 1000;
  }
  [[nodiscard]] std::int64_t now_us() const { return local_ns_ / 1000; }

 private:
  std::int64_t local_ns_ = 0;
};

/// The counters of a client's processes that have died.
struct FormerLives {
  std::uint64_t rollbacks = 0;
  std::uint64_t refused_packets = 0;
  std::uint64_t resends = 0;
};

/// How many ticks a client has stepped, now and when it last thought of giving a command.
struct TickCounts {
  std::uint64_t stepped = 0;
  std::uint64_t talked = 0;
};

/// Runs a client on its own clock, plays scripted inputs, and shows every tick to the oracle.
class Node final : public net::ClientObserver, public net::InputSource {
 public:
  Node(std::size_t index, std::uint64_t seed, std::uint8_t input_bytes, Oracle& oracle)
      : index_(index), seed_(seed), input_bytes_(input_bytes), oracle_(oracle) {}

  /// Starts the client's process: a new endpoint, a new connection.
  void start(net::SimNetwork& network, net::SimTransport& server, std::uint64_t key,
             const net::LinkFaults& faults, const net::ClientConfig& config,
             const SimulationFactory& factory, Lie lie = Lie::none);
  void kill(net::SimNetwork& network);
  /// A new connection for a client that has lost its own.
  void reconnect(net::SimNetwork& network, net::SimTransport& server,
                 const net::LinkFaults& faults);

  void update(std::int64_t span_us);

  void set_paused(bool paused) { paused_ = paused; }
  void set_skew(std::int64_t ppm) { skew_ppm_ = ppm; }

  [[nodiscard]] bool alive() const { return client_ != nullptr; }
  [[nodiscard]] const net::Client& client() const { return *client_; }
  [[nodiscard]] net::SimTransport& endpoint() const { return *endpoint_; }
  [[nodiscard]] std::uint64_t ticks() const { return ticks_.stepped; }
  [[nodiscard]] std::uint64_t refused_packets() const;
  [[nodiscard]] std::uint64_t resends() const;
  [[nodiscard]] std::uint64_t rollbacks() const;

  /// A spectator of ticks that are at least so old.
  void watch_only(std::uint32_t delay_ticks) { delay_ticks_ = delay_ticks; }

  // Callbacks of the client.
  void sample(std::uint64_t tick, std::span<std::byte> out) override;
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                    std::uint64_t hash) override;

 private:
  void talk();

  std::size_t index_;
  std::uint64_t seed_;
  std::uint8_t input_bytes_;
  Oracle& oracle_;
  SkewedClock clock_;
  std::int64_t skew_ppm_ = 0;
  bool paused_ = false;
  net::SimTransport* endpoint_ = nullptr;
  std::unique_ptr<SealedTransport> sealed_;
  std::unique_ptr<LyingTransport> lying_;
  std::unique_ptr<net::Client> client_;
  TickCounts ticks_;
  std::uint32_t delay_ticks_ = 0;
  std::uint64_t rejoin_key_ = 0;  ///< survives the process, as in a file
  FormerLives before_;
};

}  // namespace lockstone::simnet
