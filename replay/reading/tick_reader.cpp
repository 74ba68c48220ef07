#include <lockstone/replay/tick_reader.h>

namespace lockstone::replay {

Status TickReader::open(const std::optional<KeyframePlace>& from) {
  if (const Status status = reader_.open(); status != Status::ok) return status;
  if (reader_.next() != LogItem::scene) {
    const Status status = reader_.damage().status;
    return status == Status::ok ? Status::truncated : status;
  }
  config_.assign(reader_.config().begin(), reader_.config().end());
  return from ? reader_.jump(*from) : Status::ok;
}

bool TickReader::read_keyframe() {
  if (reader_.next() != LogItem::keyframe) return false;
  take_snapshot();
  return true;
}

bool TickReader::next() {
  if (++position_ < count_) {
    at_keyframe_ = false;
    ++tick_;
    return true;
  }
  at_keyframe_ = at_keyframe_ && count_ == 0;
  count_ = position_ = 0;
  for (LogItem item = reader_.next(); !is_last(item); item = reader_.next()) {
    if (item == LogItem::keyframe) take_snapshot();
    if (item != LogItem::hashes) continue;
    tick_ = reader_.chunk().first_tick;
    count_ = reader_.hashes().size();
    return true;
  }
  return false;
}

void TickReader::take_snapshot() {
  snapshot_.assign(reader_.snapshot().begin(), reader_.snapshot().end());
  at_keyframe_ = true;
}

}  // namespace lockstone::replay
