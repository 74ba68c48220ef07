// The client's side of a match: sends inputs ahead, steps what the server closed, reports hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <lockstone/net/session.h>
#include <lockstone/net/transport.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

enum class ClientState : std::uint8_t {
  connecting,   ///< the transport is not through yet
  handshaking,  ///< until seated
  lobby,        ///< seated; waits for the others
  running,
  finished,  ///< the server ended the match
  refused,   ///< see Client::refusal
  failed,    ///< see Client::failure
};

/// Why a client failed.
enum class ClientFailure : std::uint8_t {
  none = 0,
  connection_lost,
  handshake_timed_out,
  server_silent,
  server_malformed,       ///< the server's packets break the format
  config_not_understood,  ///< the factory refused the match's configuration
  dropped,                ///< the server said good-bye before the match was over; see leave_reason
};

struct ClientConfig {
  /// For a transport that does not encrypt; the server must ask for this too.
  bool insecure = false;
  std::string name;                      ///< printable ASCII, the first 32 characters
  std::uint8_t wanted_slot = k_no_slot;  ///< k_no_slot: any
  std::uint32_t history_ticks = 1024;    ///< closed ticks buffered; power of two, 256 … 65536
  std::uint32_t snapshot_ticks = 64;     ///< canonical snapshots kept, one a tick; 0 … 4096
  std::uint32_t max_lead_ticks = 16;  ///< inputs sampled beyond the delay while ticks lack; ≤ 32
  std::uint32_t max_steps_per_update = 64;    ///< above 0
  std::size_t max_snapshot_bytes = 64 << 20;  ///< a bigger simulation keeps no snapshots
  Timeouts timeouts;
};

/// Where the local player's inputs come from.
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// Fills the input for `tick`; called at most once for each tick, in order. Ticks that the server
  /// closed without waiting for it are left out. `out` comes as zeros.
  virtual void sample(std::uint64_t tick, std::span<std::byte> out) = 0;
};

/// Hears what happens. Called from within Client::update; must not call the client.
class ClientObserver {
 public:
  virtual ~ClientObserver() = default;
  virtual void joined(std::uint8_t slot);
  virtual void match_started();
  /// A tick was stepped; `hash` is the state after it.
  virtual void tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                            std::uint64_t hash);
  /// Nothing came from the server since the silence warning time.
  virtual void server_silent(std::int64_t silent_us);
  /// The server found states that differ; without dumps.
  virtual void desync_reported(const DesyncReport& report);
  virtual void match_finished(FinishReason reason, std::uint64_t ticks);
};

/// What the client works with; all outlive it. `observer` may be null.
struct ClientParts {
  Transport* transport = nullptr;
  ConnectionId connection = k_no_connection;  ///< to the server, from the transport's connect
  SimulationFactory factory;
  InputSource* inputs = nullptr;
  ClientObserver* observer = nullptr;
};

/// Driven by `update`; one thread. Memory does not grow once the client is seated.
class Client {
 public:
  struct Created {
    std::unique_ptr<Client> client;  ///< null on an error
    SetupError error = SetupError::none;
  };
  [[nodiscard]] static Created create(const ClientConfig& config, ClientParts parts);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Does all that is due: call at least once a tick. `now_us` never runs backwards. Takes all
  /// events of the transport: a client needs one of its own.
  void update(std::int64_t now_us);

  /// Leaves the match: the client is then finished (and its slot absent).
  void leave();

  [[nodiscard]] ClientState state() const;
  [[nodiscard]] ClientFailure failure() const;
  [[nodiscard]] LeaveReason leave_reason() const;  ///< what the server's good-bye said
  [[nodiscard]] const Refusal& refusal() const;
  [[nodiscard]] FinishReason finish_reason() const;
  [[nodiscard]] std::uint8_t slot() const;  ///< k_no_slot before being seated

  /// How many ticks were stepped.
  [[nodiscard]] std::uint64_t ticks_stepped() const;

  /// Bit n: the match waits for slot n, as of the last word from the server.
  [[nodiscard]] std::uint16_t waiting_mask() const;

  /// The simulation, once the server's offer was understood; else null. Do not step or load it.
  [[nodiscard]] Simulation* simulation() const;

  [[nodiscard]] ClientStats stats() const;

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::net
