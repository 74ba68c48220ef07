// One transport for many matches: each match gets a transport of its own, for a thread of its own.
//
// One thread pumps. It hands every event to the match that the peer's token names, and sends the
// packets of all matches. Between the threads are bounded queues: a match that is slow loses its
// own packets only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <lockstone/net/open_matches.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

struct MatchRouterOptions {
  std::size_t max_matches = 256;               ///< at once; 1 … k_max_open_matches
  std::size_t max_connections = 1024;          ///< of all matches together; 1 … 4095
  std::size_t max_connections_per_match = 32;  ///< 1 … 1024
  /// Waiting packets of one match, each way; 128 KiB and 256 bytes a connection … 64 MiB. A queue
  /// keeps two such buffers, of which only the used part takes memory.
  std::size_t queue_bytes = std::size_t{512} * 1024;
};

/// Counters of the router, since its creation.
struct RouterCounters {
  std::uint64_t homeless = 0;  ///< connections of no open match, or of a full one: ended
  std::uint64_t lost = 0;      ///< unreliable packets for a match whose queue was full
  std::uint64_t broken = 0;    ///< connections ended because a reliable packet did not fit
};

/// Must not outlive the carrier, nor the list of open matches. Nothing is allocated after creation.
///
/// The transports of matches behave like the carrier, with these differences. `stats` are those of
/// the last packet received. `flush` waits for the next `pump`. A packet that the carrier refuses
/// later ends its connection if it is reliable. `secure` is the carrier's; `protect` does nothing.
class MatchRouter {
 public:
  /// invalid_argument: an option is out of range, or the carrier is not secure: tokens alone name
  /// matches.
  [[nodiscard]] static Result<std::unique_ptr<MatchRouter>> create(
      Transport& carrier, OpenMatches& matches, const MatchRouterOptions& options);
  ~MatchRouter();
  MatchRouter(const MatchRouter&) = delete;
  MatchRouter& operator=(const MatchRouter&) = delete;

  /// Opens a match: its tokens are good from here on. Returns its transport, which the router owns
  /// and one thread may use until `close`. capacity_exhausted: as many are open, or still closing;
  /// else the errors of OpenMatches::add. Any thread may call.
  [[nodiscard]] Result<Transport*> open(std::uint64_t match);

  /// Ends a match. Nobody may use its transport from here on; packets sent before still leave, then
  /// its connections end, and its place is free after the next `pump`. Any thread may call.
  void close(const Transport& transport);

  /// Hands over all that has come, and sends all that waits. One thread.
  void pump(std::int64_t now_us);

  /// For the thread that pumps.
  [[nodiscard]] const RouterCounters& counters() const;

 private:
  struct Impl;
  explicit MatchRouter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::net
