// Writes on a thread of its own, so that a slow disk never stalls a tick.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include <lockstone/replay/sink.h>

namespace lockstone::replay {

/// A bounded queue in front of another sink. `append` copies and returns; a group of chunks either
/// goes in whole or not at all. Nothing is allocated after construction.
class BackgroundSink final : public Sink {
 public:
  /// Two seconds and a keyframe of a large match.
  static constexpr std::size_t k_default_queue_bytes = 16U << 20;

  /// `inner` must outlive this and is used by the thread alone until close().
  explicit BackgroundSink(Sink& inner, std::size_t queue_bytes = k_default_queue_bytes);

  /// close().
  ~BackgroundSink() override;

  BackgroundSink(const BackgroundSink&) = delete;
  BackgroundSink& operator=(const BackgroundSink&) = delete;

  /// Never waits for the disk. capacity_exhausted when the queue has no room: the disk is slower
  /// than the match. The inner sink's status when an earlier group could not be written. After
  /// either every call answers it again, and a recorder gives the log up at a chunk's end.
  Status append(ByteView bytes) override;

  /// Waits until all is written, and ends the thread. The first bad status. May be called again.
  Status close();

  /// Bytes waiting now, and the most there ever were.
  [[nodiscard]] std::size_t waiting_bytes() const;
  [[nodiscard]] std::size_t most_waiting_bytes() const;

 private:
  void run();
  void put(ByteView bytes);
  [[nodiscard]] ByteView next_piece() const;

  Sink& inner_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::byte> ring_;
  std::size_t first_ = 0;  // of the waiting bytes in the ring
  std::size_t waiting_ = 0;
  std::size_t most_waiting_ = 0;
  Status status_ = Status::ok;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace lockstone::replay
