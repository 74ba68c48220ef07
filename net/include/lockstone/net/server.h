// The server's side of a match: seats the players, confirms tick after tick, compares states.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/net/session.h>
#include <lockstone/net/transport.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

/// The replacement of a late input (LatePolicy::deadline).
enum class Substitute : std::uint8_t {
  repeat,   ///< the slot's input of the tick before
  neutral,  ///< all zero
};
[[nodiscard]] std::string_view to_string(Substitute substitute);

/// The treatment of a player whose state is wrong. Without a judge and a majority the match always
/// ends. Where it goes on, it goes on at once: the player is absent from the verdict on.
enum class DesyncPolicy : std::uint8_t {
  end_match,  ///< the match stands still until the report is complete, then it ends
  kick,       ///< the player is refused for the rest of the match (RefuseReason::expelled)
  resync,     ///< send the right state, once a player; kick it the second time
};

/// Counters of a server since its creation.
struct ServerCounters {
  std::array<std::uint64_t, k_refuse_reasons> refused{};  ///< handshakes, by RefuseReason
  std::array<std::uint64_t, k_leave_reasons> left{};      ///< players, by LeaveReason
  std::array<std::uint64_t, k_verdicts> verdicts{};       ///< wrong states, by Verdict
  std::uint64_t resyncs = 0;                              ///< right states sent to wrong players
  std::uint64_t expelled = 0;                             ///< players sent away for good
  std::uint64_t malformed_packets = 0;                    ///< of everybody
  std::uint64_t turned_away = 0;  ///< connections for which there was no place
};

/// How many connections are in which state.
struct ConnectionCounts {
  std::size_t greeting = 0;  ///< connected, not yet through the handshake
  std::size_t players = 0;
  std::size_t condemned = 0;  ///< players whose state was wrong, about to be kicked or corrected
  std::size_t spectators = 0;
};
[[nodiscard]] std::string_view to_string(DesyncPolicy policy);

enum class ServerState : std::uint8_t {
  lobby,      ///< waits for all players
  running,    ///< confirms ticks: makes their inputs final
  finishing,  ///< all ticks confirmed; waits for the last hashes
  closing,    ///< says good-bye
  over,       ///< nothing more will happen
};
[[nodiscard]] std::string_view to_string(ServerState state);

/// The commands that a server takes of each player. Two seconds' worth may come at once; more are
/// refused, and the player is told.
struct CommandLimits {
  std::uint32_t max_bytes = k_max_command_bytes;  ///< of one; 0: none are taken
  std::uint32_t per_second = 10;                  ///< 0: no limit
  std::uint32_t bytes_per_second = 32 * 1024;     ///< 0: no limit
};

struct ServerConfig {
  /// Set this, and only this, for a transport that does not encrypt: anybody may then join, listen
  /// and forge.
  bool insecure = false;
  std::vector<std::byte> match_config;  ///< for the clients' SimulationFactory; ≤ 32 KiB
  SimulationInfo info;                  ///< of a relay; unused where the server simulates
  std::uint64_t tick_count = 0;         ///< ticks to play; 0: until `stop`
  /// The match goes on from where the simulation stands, above tick 0: its server was killed. It
  /// waits for these slots' players (bit n: slot n), at most Timeouts::drop_us after the first
  /// came.
  std::optional<SlotMask> resume_mask;
  std::uint8_t input_delay_ticks = 4;  ///< 0 … 60
  LatePolicy late_policy = LatePolicy::deadline;
  Substitute substitute = Substitute::repeat;
  Pacing pacing = Pacing::real_time;
  DesyncPolicy desync_policy = DesyncPolicy::resync;
  std::uint32_t history_ticks =
      1024;  ///< confirmed ticks kept for laggards; power of two, 256 … 65536
  std::uint32_t snapshot_ticks = 64;      ///< canonical snapshots kept, one a tick; 0 … 4096
  std::size_t max_dump_bytes = 16 << 20;  ///< of a client's snapshot, where no simulation says
  /// Ticks run without a player in its seat, and a player who comes later may take it.
  bool late_join = true;
  std::uint8_t start_players = 0;  ///< the match begins with this many; 0: with all
  /// Makes the keys that open a seat again. Use random bits: anybody who guesses a key gets the
  /// seat.
  std::uint64_t rejoin_seed = 0;
  std::uint16_t max_spectators = 0;           ///< 0 … 256
  std::uint32_t spectator_delay_ticks = 0;    ///< how old the newest tick is that they see
  std::uint32_t spectator_queue_ticks = 600;  ///< one that lacks more than these is dropped
  CommandLimits commands;
  std::uint32_t entry_bytes_per_s = 1 << 20;  ///< of states sent to those who enter, all together
  Timeouts timeouts;
};

/// Receives the server's events. Called from within Server::update; must not call the server.
class ServerObserver {
 public:
  virtual ~ServerObserver() = default;

  /// A tick is confirmed: its inputs are final. `hash` is the state after it, where the server
  /// simulates.
  virtual void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                              std::optional<std::uint64_t> hash);
  /// The commands of a tick that is about to be told as confirmed, where it has any.
  virtual void commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands);
  /// Relay: all players that reported this tick had this hash.
  virtual void hash_agreed(std::uint64_t tick, std::uint64_t hash);
  virtual void player_joined(std::uint8_t slot, std::string_view name);
  virtual void player_left(std::uint8_t slot, LeaveReason reason);
  /// Nothing came from the player since the silence warning time.
  virtual void player_silent(std::uint8_t slot, std::int64_t silent_us);
  virtual void player_refused(const Refusal& refusal);
  virtual void desync_found(const DesyncReport& report);
  virtual void match_started();
  /// A player came into a match that runs, or came back: from `tick` on it plays.
  virtual void player_active(std::uint8_t slot, std::uint64_t tick);
  /// A player's request: answer it by calling the server after `update`, or not at all.
  virtual void player_asks(std::uint8_t slot, AskKind kind, std::uint8_t topic,
                           std::uint8_t choice);
  virtual void match_finished(FinishReason reason, std::uint64_t ticks,
                              std::optional<std::uint64_t> hash);
};

/// The objects that the server uses; all outlive it. Only `transport` must be given.
struct ServerParts {
  Transport* transport = nullptr;
  /// Steps along and judges (authoritative). Null: relay, the majority of the players judges.
  Simulation* simulation = nullptr;
  /// Relay: explains a difference between two dumps. May be null.
  const Simulation* describer = nullptr;
  ServerObserver* observer = nullptr;
};

/// Driven by `update`; one thread. Memory does not grow after creation, except for the dumps of a
/// desync, which are bounded.
class Server {
 public:
  struct Created {
    std::unique_ptr<Server> server;  ///< null on an error
    SetupError error = SetupError::none;
  };
  [[nodiscard]] static Created create(const ServerConfig& config, const ServerParts& parts);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Does all that is due: call at least once a tick. `now_us` never runs backwards.
  void update(std::int64_t now_us);

  /// A command of the server's own (k_server_slot), for the next tick that has room. The bytes are
  /// copied. invalid_argument for none or too many; capacity_exhausted while too many wait.
  Status send_command(ByteView bytes);

  /// Ends the match after the ticks confirmed so far.
  void stop();

  /// No ticks are confirmed until `resume`. The players are told.
  void pause();
  void resume();
  [[nodiscard]] bool paused() const;

  [[nodiscard]] ServerState state() const;
  [[nodiscard]] FinishReason finish_reason() const;  ///< once finishing is over

  /// How many ticks are confirmed: tick 0 … ticks_confirmed() - 1.
  [[nodiscard]] std::uint64_t ticks_confirmed() const;

  [[nodiscard]] std::size_t spectators() const;

  /// Bit n: slot n is seated.
  [[nodiscard]] SlotMask present_mask() const;

  /// Bit n: the match waits for slot n's input, or for a word that it has the ticks and their
  /// hashes (LatePolicy::strict, Pacing::fast).
  [[nodiscard]] SlotMask waiting_mask() const;

  /// The name of a slot's player, kept after it left. `slot` is below the player count.
  [[nodiscard]] std::string_view player_name(std::uint8_t slot) const;

  /// Counters of a slot's player, kept after it left. `slot` is below the player count.
  [[nodiscard]] PlayerStats stats(std::uint8_t slot) const;

  [[nodiscard]] const ServerCounters& counters() const;
  [[nodiscard]] ConnectionCounts connections() const;

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::net
