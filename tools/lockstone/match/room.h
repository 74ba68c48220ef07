// A place for one match after another, and the plan that all places of a process share.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include <lockstone/net/match_router.h>

#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/match/metrics.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {

struct RoomsOptions;

struct EndedMatches {
  std::uint64_t count = 0;
  MatchMetrics sum;
  int code = 0;  ///< exit code of the worst
};

/// Gives out the matches that follow, and sums the ended ones up. Any thread may call.
class RoomsProgram {
 public:
  RoomsProgram(const Games& games, const MatchOptions& match, const RoomsOptions& options);

  /// The options of the next match; nothing when none follows.
  [[nodiscard]] std::optional<MatchOptions> next();
  [[nodiscard]] bool takes_more() const;

  void drain() { draining_ = true; }
  void stop() { stopping_ = true; }
  void measure() { measuring_ = true; }
  [[nodiscard]] bool draining() const { return draining_; }
  [[nodiscard]] bool stopping() const { return stopping_; }
  [[nodiscard]] bool measuring() const { return measuring_; }

  void note_begun() const;
  void note_ended(const MatchHost& host, bool begun, int code);
  /// A match could not be set up: no more follow.
  void note_failed(int code);
  [[nodiscard]] EndedMatches ended() const;
  [[nodiscard]] const TickLateness& lateness() const { return lateness_; }
  [[nodiscard]] const Games& games() const { return games_; }

 private:
  [[nodiscard]] bool takes_more_locked() const;

  const Games& games_;
  MatchOptions match_;
  const RoomsOptions& options_;
  std::atomic<bool> draining_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> measuring_{false};
  mutable std::mutex mutex_;
  std::uint64_t begun_ = 0;  ///< how many options were given out
  EndedMatches ended_;
  TickLateness lateness_;
};

/// One worker at a time is in a room.
class Room {
 public:
  Room(RoomsProgram& program, net::MatchRouter& router) : program_(program), router_(router) {}

  /// Does the work that is due, unless another worker is here.
  void try_work(const Stopwatch& watch);

  /// No match is here, and none will be.
  [[nodiscard]] bool closed() const { return closed_; }

  /// Of the match that is here, at most a quarter of a second old.
  [[nodiscard]] std::optional<MatchMetrics> metrics() const;

 private:
  void work(std::int64_t now_us);
  void open();
  void obey();
  void publish(std::int64_t now_us);
  void close();

  RoomsProgram& program_;
  net::MatchRouter& router_;
  std::mutex mutex_;  ///< of the worker that is here
  std::int64_t next_us_ = 0;
  std::optional<MatchOptions> coming_;  ///< the match that is to be opened
  net::Transport* line_ = nullptr;
  std::unique_ptr<MatchHost> host_;
  bool begun_ = false;
  bool drained_ = false;
  bool stopped_ = false;
  bool measured_ = false;
  std::atomic<bool> closed_{false};
  std::int64_t next_metrics_us_ = 0;
  mutable std::mutex metrics_mutex_;
  std::optional<MatchMetrics> metrics_;
};

}  // namespace lockstone::tool
