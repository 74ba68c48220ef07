// A server with its simulation and its log, for `serve` and `demo`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/net/token.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/simulation.h>

#include "tools/lockstone/match/metrics.h"
#include "tools/lockstone/match/tick_lateness.h"
#include "tools/lockstone/match/web_players.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/start_match.h"

namespace lockstone::tool {

struct MatchOptions {
  StartOptions start;
  std::uint64_t ticks = 3600;  ///< 0: until interrupted
  std::string bind = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: the system chooses
  WebPlayers web;
  std::size_t max_per_address = net::EnetOptions{}.max_connections_per_address;
  unsigned input_delay = 4;
  double drop_after_s = 5;  ///< of silence
  bool strict = false;
  bool fast = false;
  bool insecure = false;
  std::optional<net::Key> key;  ///< seals the tokens; none: insecure
  std::uint64_t match = 0;      ///< of the tokens
  net::ServerList addresses;  ///< the addresses of this server that tokens may name; none: no check
  std::string record;         ///< empty: no log
  std::string resume;         ///< the log of a killed server, whose match goes on; empty: none
  unsigned start_players = 0;  ///< the match begins with this many; 0: with all
  std::uint16_t spectators = 0;
  unsigned spectator_delay_s = 0;
  net::DesyncPolicy desync_policy = net::DesyncPolicy::resync;
  std::string bundle;              ///< the first desync is written to this file; empty: nowhere
  std::uint16_t metrics_port = 0;  ///< 0: none
  std::string metrics_bind = "127.0.0.1";
  bool json_log = false;                          ///< print JSON, one object a line
  bool silent = false;                            ///< print nothing
  bool force = false;                             ///< replace files that are there
  std::optional<replay::SigningKey> signing_key;  ///< of the log; none: it is not signed
};

/// The outcome of a match.
struct MatchSummary {
  std::uint64_t ticks = 0;
  double seconds = 0;          ///< from the first tick to the last
  double longest_seconds = 0;  ///< between two ticks
  net::FinishReason reason = net::FinishReason::stopped;
  std::uint64_t final_hash = 0;
  unsigned desyncs = 0;
  Status record_status = Status::ok;
  std::vector<net::PlayerStats> players;
};

/// One match. Prints joins, leaves, refusals and desyncs as they come.
class MatchHost {
 public:
  /// Null, with a complaint, when it cannot be set up. With `line`, which must outlive it, the
  /// match has neither a socket nor a port for metrics, and is called by the number of its tokens.
  [[nodiscard]] static std::unique_ptr<MatchHost> create(const Games& games,
                                                         const MatchOptions& options,
                                                         net::Transport* line = nullptr);
  ~MatchHost();

  /// 0 without a socket.
  [[nodiscard]] std::uint16_t port() const;
  /// Where browsers call; empty: nowhere.
  [[nodiscard]] std::string web_address() const;

  /// Does the work that is due, and rests a moment when there was none; false once the match is
  /// over.
  [[nodiscard]] bool update();

  /// As `update`, without rest, progress and metrics port.
  [[nodiscard]] bool step();

  /// The match has begun.
  [[nodiscard]] bool begun() const;

  /// How punctual the ticks were, since the beginning or the last restart.
  [[nodiscard]] const TickLateness& lateness() const;
  void restart_lateness();

  /// Ends the match after the ticks confirmed so far.
  void stop();

  /// Prints the outcome.
  void say_summary(const MatchSummary& summary);

  /// Takes no new match: one that runs is played to its end, one that waits for players ends. The
  /// match is no longer ready.
  void drain();

  /// Finishes the log and sums up. Once.
  [[nodiscard]] MatchSummary finish();

  [[nodiscard]] const Simulation& simulation() const;
  [[nodiscard]] const GameDef& game() const;
  [[nodiscard]] std::uint64_t ticks_confirmed() const;

  [[nodiscard]] MatchMetrics metrics() const;

  /// A line about how it goes.
  [[nodiscard]] std::string progress_line() const;
  [[nodiscard]] Progress& progress();

 private:
  struct Impl;
  explicit MatchHost(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::tool
