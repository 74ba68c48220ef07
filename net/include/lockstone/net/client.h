// The client's side of a match: sends inputs ahead, steps the ticks that the server confirmed,
// reports hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <lockstone/net/session.h>
#include <lockstone/net/transport.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

enum class ClientState : std::uint8_t {
  connecting,   ///< the transport is not through yet
  handshaking,  ///< until seated
  lobby,        ///< seated; waits for the others
  joining,      ///< seated in a match that runs; gets its state
  running,
  finished,  ///< the server ended the match
  refused,   ///< see Client::refusal
  failed,    ///< see Client::failure
};
[[nodiscard]] std::string_view to_string(ClientState state);

/// Why a client failed.
enum class ClientFailure : std::uint8_t {
  none = 0,
  connection_lost,
  handshake_timed_out,
  server_silent,
  server_malformed,       ///< the server's packets break the format
  config_not_understood,  ///< the factory refused the match's configuration
  dropped,                ///< the server said good-bye before the match was over; see leave_reason
  not_deterministic,      ///< stepping the same ticks again gave another state (sync_test)
};
[[nodiscard]] std::string_view to_string(ClientFailure failure);

struct ClientConfig {
  /// For a transport that does not encrypt; the server must ask for this too.
  bool insecure = false;
  std::string name;                      ///< as PlayerName takes it
  std::uint8_t wanted_slot = k_no_slot;  ///< k_no_slot: any; k_spectator_slot: only watch
  std::string build;             ///< of the game and the machine, for reports; 64 characters
  std::uint64_t rejoin_key = 0;  ///< Client::rejoin_key of a former process: the same seat again
  std::uint32_t history_ticks = 1024;  ///< confirmed ticks buffered; power of two, 256 … 65536
  std::uint32_t snapshot_ticks = 64;   ///< canonical snapshots kept, one a tick; 0 … 4096
  std::uint32_t max_lead_ticks = 16;   ///< inputs sampled beyond the delay while ticks lack; ≤ 32
  std::uint32_t max_steps_per_update = 64;  ///< above 0
  bool adapt_lead = true;  ///< send inputs earlier when they come late, later when there is time
  bool play_out_evenly = true;  ///< keep ticks back as long as their arrival jitters, ≤ 250 ms
  /// Rollback: ticks stepped beyond the confirmed ones, on guesses; 0 … 15. 0: lockstep.
  std::uint8_t prediction_ticks = 0;
  std::uint8_t prediction_delay_ticks = 0;  ///< own inputs show that much later, and fewer guesses
  /// Rollback: the simulation remembers the ticks that may be stepped again.
  bool keep_history = true;
  /// Roll back every tick; step it again in full, and from the history; compare: for tests.
  bool sync_test = false;
  std::size_t max_snapshot_bytes = 64 << 20;  ///< a bigger simulation keeps no snapshots
  Timeouts timeouts;
};

/// Where the local player's inputs come from.
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// Fills the input for `tick`; called at most once for each tick, in order. Ticks that the server
  /// confirmed without waiting for it are left out. `out` comes as zeros.
  virtual void sample(std::uint64_t tick, std::span<std::byte> out) = 0;
};

/// Receives the client's events. Called from within Client::update; must not call the client.
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
  /// The state after `ticks` ticks came from the server: all seen so far is void.
  virtual void state_loaded(std::uint64_t ticks);
  /// From `tick` on, the player of `slot` plays: it came late, or came back.
  virtual void player_active(std::uint8_t slot, std::uint64_t tick);
  virtual void pause_changed(bool paused);
  /// The player of `slot` has this name: told of all players, also of this one.
  virtual void player_named(std::uint8_t slot, std::string_view name);
  /// The commands of a tick that is about to be told as stepped, where it has any.
  virtual void commands_stepped(std::uint64_t tick, std::span<const PlayerCommand> commands);
  /// The server did not take a command: too many came, or it is too long for this match.
  virtual void command_refused(std::uint64_t number);
  /// The server replaced this player's input for a tick: it came too late.
  virtual void input_replaced(std::uint64_t tick);
  /// Rollback: a tick was stepped on guesses. It may be stepped again, then told of again.
  virtual void tick_predicted(std::uint64_t tick, std::span<const PlayerInput> inputs);
  /// Rollback: the last `count` guessed ticks, from `tick` on, are void.
  virtual void rolled_back(std::uint64_t tick, std::uint64_t count);
};

/// Guesses the inputs of other players (rollback).
class InputPredictor {
 public:
  virtual ~InputPredictor() = default;
  /// `out` comes as the slot's last known input, which is the guess if nothing is changed.
  virtual void predict(std::uint64_t tick, std::uint8_t slot, std::span<std::byte> out) = 0;
};

/// The objects that the client uses; all outlive it. `observer` may be null.
struct ClientParts {
  Transport* transport = nullptr;
  ConnectionId connection = k_no_connection;  ///< to the server, from the transport's connect
  SimulationFactory factory;
  InputSource* inputs = nullptr;
  ClientObserver* observer = nullptr;
  InputPredictor* predictor = nullptr;  ///< may be null: inputs are held
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

  /// Whether it may help to call again: the connection was lost, the server was silent, or the
  /// handshake took too long. Not after a refusal for good, nor when the server sent this player
  /// away.
  [[nodiscard]] bool may_reconnect() const;

  /// After a failure of the connection, or a handshake that took too long: goes on over a new one,
  /// in the same seat if the server has kept it, with the state that is here. False, and nothing
  /// happens, in other states.
  bool reconnect(ConnectionId connection);

  /// Opens the same seat again, also for another process; 0 before being seated.
  [[nodiscard]] std::uint64_t rejoin_key() const;

  /// Gives a command, 1 … k_max_command_bytes bytes, which are copied. The server binds it to a
  /// tick; everybody's simulation gets it there. Returns its number. invalid_argument for no bytes
  /// or too many, or of a spectator; capacity_exhausted while too many are on their way; not_found
  /// before being seated.
  [[nodiscard]] Result<std::uint64_t> send_command(ByteView bytes);

  /// Asks the server's owner for something.
  void ask(AskKind kind, std::uint8_t topic = 0, std::uint8_t choice = 0);
  [[nodiscard]] bool paused() const;

  /// Leaves the match: the client is then finished (and its slot absent).
  void leave();

  [[nodiscard]] ClientState state() const;
  [[nodiscard]] ClientFailure failure() const;
  [[nodiscard]] LeaveReason leave_reason() const;  ///< the reason in the server's good-bye
  [[nodiscard]] const Refusal& refusal() const;
  [[nodiscard]] FinishReason finish_reason() const;
  [[nodiscard]] std::uint8_t slot() const;  ///< k_no_slot before being seated

  /// The name of a slot's player, kept after it left; empty where it gave none, or before the
  /// server told it.
  [[nodiscard]] std::string_view player_name(std::uint8_t slot) const;

  /// How many confirmed ticks were stepped.
  [[nodiscard]] std::uint64_t ticks_stepped() const;

  /// Rollback: ticks stepped, guessed ones included; else as ticks_stepped.
  [[nodiscard]] std::uint64_t ticks_predicted() const;

  /// The first tick with an input of this player; no tick yet before the server announced it.
  [[nodiscard]] std::optional<std::uint64_t> active_tick() const;

  /// Bit n: the match waits for slot n, as of the last word from the server.
  [[nodiscard]] SlotMask waiting_mask() const;

  /// The simulation, once the server's offer was understood; else null. Do not step or load it.
  [[nodiscard]] Simulation* simulation() const;

  [[nodiscard]] ClientStats stats() const;

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::net
