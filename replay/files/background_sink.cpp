#include <algorithm>

#include <lockstone/replay/background_sink.h>

namespace lockstone::replay {

BackgroundSink::BackgroundSink(Sink& inner, std::size_t queue_bytes)
    : inner_(inner), ring_(std::max<std::size_t>(queue_bytes, 1)) {
  thread_ = std::thread([this] { run(); });
}

BackgroundSink::~BackgroundSink() {
  static_cast<void>(close());
}

Status BackgroundSink::append(ByteView bytes) {
  {
    const std::lock_guard lock(mutex_);
    if (status_ != Status::ok || closing_) {
      return status_ == Status::ok ? Status::invalid_argument : status_;
    }
    if (bytes.size() > ring_.size() - waiting_) return status_ = Status::capacity_exhausted;
    put(bytes);
  }
  changed_.notify_one();
  return Status::ok;
}

void BackgroundSink::put(ByteView bytes) {
  const std::size_t end = (first_ + waiting_) % ring_.size();
  const std::size_t before_wrap = std::min(bytes.size(), ring_.size() - end);
  std::copy_n(bytes.begin(), before_wrap, ring_.begin() + static_cast<std::ptrdiff_t>(end));
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(before_wrap), bytes.end(), ring_.begin());
  waiting_ += bytes.size();
  most_waiting_ = std::max(most_waiting_, waiting_);
}

ByteView BackgroundSink::next_piece() const {
  return std::span(ring_).subspan(first_, std::min(waiting_, ring_.size() - first_));
}

// Waiting bytes are written without the lock: append() only writes where nothing waits.
void BackgroundSink::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return waiting_ > 0 || closing_; });
    if (waiting_ == 0) return;
    const ByteView piece = next_piece();
    lock.unlock();
    const Status status = inner_.append(piece);
    lock.lock();
    first_ = (first_ + piece.size()) % ring_.size();
    waiting_ -= piece.size();
    if (status == Status::ok) continue;
    status_ = status;
    waiting_ = 0;
    return;
  }
}

Status BackgroundSink::close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
  return status_;
}

std::size_t BackgroundSink::waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  return waiting_;
}

std::size_t BackgroundSink::most_waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  return most_waiting_;
}

}  // namespace lockstone::replay
