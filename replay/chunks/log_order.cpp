#include "replay/chunks/log_order.h"

#include <utility>

#include <lockstone/assert.h>

namespace lockstone::replay {

void LogOrder::jump(std::uint64_t tick) {
  seen_ = {};
  transcript_ = {};
  last_keyframe_.reset();
  next_tick_ = tick;
  awaits_inputs_ = awaits_hashes_ = false;
  arrives_ = jumped_ = true;
}

const char* LogOrder::check(const ChunkHeader& chunk) const {
  const ChunkType type = chunk.type;
  if (has_scene_ == (type == ChunkType::scene)) return "the scene comes first, and once";
  if (arrives_ && type != ChunkType::keyframe) return "not the keyframe looked for";
  if (awaits_inputs_ && type != ChunkType::input) {
    return "each COMMAND chunk is followed by its INPUT chunk";
  }
  if (awaits_hashes_ != (type == ChunkType::hash)) {
    return "each INPUT chunk is followed by its HASH chunk";
  }
  if (type == ChunkType::keyframe && last_keyframe_ == chunk.first_tick) {
    return "a second keyframe of one tick";
  }
  const std::uint64_t behind = type == ChunkType::hash ? input_ticks_ : 0;
  return chunk.first_tick == next_tick_ - behind ? nullptr : "not at the log's next tick";
}

const char* LogOrder::check_start() const {
  const bool lacks = start_tick_ > 0 && seen_.keyframes == 0;
  return lacks ? "no keyframe at the start tick" : nullptr;
}

const char* LogOrder::check_keyframe(std::uint64_t hash) const {
  const bool differs = seen_.ticks > 0 && hash != seen_.final_hash;
  return differs ? "its hash is not that of the tick before" : nullptr;
}

const char* LogOrder::check_end(const LogEnd& end) const {
  const bool ends_here = end.final_tick == next_tick_ && end.final_hash == seen_.final_hash;
  const bool counts = jumped_ || (end.ticks == seen_.ticks && end.events == seen_.events &&
                                  end.keyframes == seen_.keyframes);
  if (!ends_here || !counts) return "its totals are not those of the log";
  const bool other = !jumped_ && end.transcript != transcript_.value();
  return other ? "its transcript is not that of the log's inputs" : nullptr;
}

void LogOrder::note_inputs(std::uint32_t ticks) {
  LKS_ASSERT(!awaits_hashes_ && ticks > 0);
  awaits_inputs_ = false;
  input_ticks_ = ticks;
  awaits_hashes_ = true;
  next_tick_ += ticks;
}

void LogOrder::note_hashes(std::uint64_t last_hash) {
  LKS_ASSERT(awaits_hashes_);
  awaits_hashes_ = false;
  seen_.ticks += input_ticks_;
  seen_.final_hash = last_hash;
}

void LogOrder::note_keyframe(std::uint64_t tick, std::uint64_t hash) {
  if (arrives_ && tick > start_tick_) seen_.final_hash = hash;  // of the tick before it
  arrives_ = false;
  last_keyframe_ = tick;
  ++seen_.keyframes;
}

bool LogOrder::take_signature() {
  LKS_ASSERT(complete_);
  return !std::exchange(signed_, true);
}

}  // namespace lockstone::replay
