// A relay of TCP connections that delays segments as a lossy network does. A model: the relay loses
// none, but holds back each that the network would have lost, with all that follow it, for as long as
// its retransmission would have taken.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <lockstone/bytes.h>

#include "net/transport/random.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::relay {

struct SegmentFaults {
  std::uint32_t loss_ppm = 0;  ///< of all segments, and of their retransmissions
  std::int64_t delay_us = 0;   ///< one way
  std::int64_t jitter_us = 0;  ///< the delay is uniform in delay ± jitter; the order stays
};

struct SegmentCounters {
  std::uint64_t connections = 0;
  std::uint64_t segments = 0;
  std::uint64_t lost = 0;
  std::int64_t longest_us = 0;  ///< that a segment was held back by losses
};

class TcpRelay {
 public:
  static constexpr std::size_t k_segment_bytes = 1448;
  static constexpr std::size_t k_max_connections = 64;
  /// A first loss is repaired after a round trip and the time in which three more segments make the
  /// receiver's duplicate acknowledgements (RFC 5681, section 3.2), at sixty a second.
  static constexpr std::int64_t k_three_segments_us = 50'000;
  /// A lost retransmission waits for the time-out, which doubles (RFC 6298; Linux' least).
  static constexpr std::int64_t k_time_out_us = 200'000;

  /// io_error: the system refused.
  [[nodiscard]] static Result<std::unique_ptr<TcpRelay>> open(const Endpoint& local,
                                                              const Endpoint& server,
                                                              const SegmentFaults& faults,
                                                              std::uint64_t seed);
  ~TcpRelay();
  TcpRelay(const TcpRelay&) = delete;
  TcpRelay& operator=(const TcpRelay&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Takes and forwards all that there is, and is due. Does not wait.
  void pump(std::int64_t now_us);

  [[nodiscard]] const SegmentCounters& counters() const { return counters_; }

 private:
  struct Segment {
    std::int64_t due_us;
    std::vector<std::byte> bytes;  ///< none: the end of the stream
  };
  struct Way {
    int from, to;
    net::Random random;
    std::deque<Segment> waiting;
    std::int64_t last_due_us = 0;
    bool ended = false;
  };

  TcpRelay(int listener, const Endpoint& server, const SegmentFaults& faults, std::uint64_t seed)
      : listener_(listener), server_(server), faults_(faults), seed_(seed) {}
  void accept_callers();
  void take(Way& way, std::int64_t now_us);
  void enqueue(Way& way, ByteView bytes, std::int64_t now_us);
  [[nodiscard]] std::int64_t draw_repair_us(Way& way);
  static void forward(Way& way, std::int64_t now_us);

  int listener_;
  Endpoint server_;
  SegmentFaults faults_;
  std::uint64_t seed_;
  std::vector<Way> ways_;  ///< two of each connection, one after the other
  SegmentCounters counters_;
};

}  // namespace lockstone::relay
