// Many matches in one process: one UDP socket, one thread for it, and workers that run the matches.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/match/metrics.h"

namespace lockstone::tool {

class Agones;

struct RoomsOptions {
  unsigned rooms = 1;                  ///< matches at once
  unsigned workers = 0;                ///< threads; 0: one less than the machine's processors
  std::uint64_t matches = 0;           ///< in all; 0: without end
  bool per_address_unlimited = false;  ///< all players are on this machine
  Agones* agones = nullptr;            ///< hears of matches; may be null
};

/// Time on a processor that the threads have taken, in seconds.
struct RoomsTime {
  double socket = 0;
  double workers = 0;
};

/// Keeps as many matches open as there are rooms. Their numbers and seeds count up from those of
/// MatchOptions, and are not used again.
class Rooms {
 public:
  /// Null, with a complaint, when they cannot be set up. The threads run from here on.
  [[nodiscard]] static std::unique_ptr<Rooms> open(const Games& games, const MatchOptions& match,
                                                   const RoomsOptions& options);
  ~Rooms();

  [[nodiscard]] std::uint16_t port() const;
  /// Where browsers call; empty: nowhere.
  [[nodiscard]] const std::string& web_address() const;

  /// No new match begins; those that run are played to their end.
  void drain();
  /// All matches end after the ticks confirmed so far.
  void stop();
  /// All matches have ended, and none follows.
  [[nodiscard]] bool over() const;
  /// The threads run: none has hung for ten seconds but workers, of which one is left.
  [[nodiscard]] bool alive() const;

  [[nodiscard]] RoomsMetrics metrics() const;
  [[nodiscard]] RoomsTime time() const;

  /// Once it is over: the last packets have left, and the threads are gone. Returns the exit code
  /// of the worst match.
  [[nodiscard]] int finish();

  /// The ticks until now do not count as late or punctual.
  void restart_lateness();

  /// After `finish`: of the ticks of all matches.
  [[nodiscard]] const TickLateness& lateness() const;

 private:
  struct Impl;
  explicit Rooms(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::tool
