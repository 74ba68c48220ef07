// The payload of INDEX chunks as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/replay/log_map.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// A longer match keeps every second keyframe in its index, and so on.
inline constexpr std::size_t k_max_index_entries = 4096;

inline constexpr std::size_t k_index_entry_bytes = 16;
inline constexpr std::size_t k_max_index_bytes =
    k_max_index_entries * k_index_entry_bytes + sizeof(std::uint64_t);

/// The keyframes written so far. Takes its memory at once.
class IndexBuilder {
 public:
  IndexBuilder() { places_.reserve(k_max_index_entries); }

  void add(const KeyframePlace& place);
  [[nodiscard]] std::span<const KeyframePlace> places() const { return places_; }

 private:
  std::vector<KeyframePlace> places_;
  std::uint32_t stride_ = 1;  // of the keyframes given, every stride_th is kept
  std::uint32_t given_ = 0;
};

/// `chunk_offset` is that of the INDEX chunk itself.
void encode_index(ByteWriter& writer, std::span<const KeyframePlace> places,
                  std::uint64_t chunk_offset);

/// Replaces `places`: ascending, all before `chunk_offset`.
[[nodiscard]] DecodeFault decode_index(ByteView payload, std::uint64_t chunk_offset,
                                       std::vector<KeyframePlace>& places);

}  // namespace lockstone::replay
