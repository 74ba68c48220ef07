#include "replay/codec/index_codec.h"

#include <algorithm>

namespace lockstone::replay {

void IndexBuilder::add(const KeyframePlace& place) {
  if (given_++ % stride_ != 0) return;
  if (places_.size() == k_max_index_entries) {
    for (std::size_t i = 0; i < places_.size() / 2; ++i)
      places_[i] = places_[2 * i];
    places_.resize(places_.size() / 2);
    stride_ *= 2;
  }
  places_.push_back(place);
}

void encode_index(ByteWriter& writer, std::span<const KeyframePlace> places,
                  std::uint64_t chunk_offset) {
  for (const KeyframePlace& place : places) {
    writer.put(place.tick);
    writer.put(place.offset);
  }
  writer.put(chunk_offset);
}

DecodeFault decode_index(ByteView payload, std::uint64_t chunk_offset,
                         std::vector<KeyframePlace>& places) {
  places.clear();
  if (payload.size() % k_index_entry_bytes != sizeof(std::uint64_t) ||
      payload.size() > k_max_index_bytes) {
    return malformed(0, "not whole entries and the index's own offset");
  }
  ByteReader reader(payload);
  while (reader.remaining() > sizeof(std::uint64_t)) {
    const std::size_t position = reader.position();
    const auto tick = reader.get<std::uint64_t>();
    const KeyframePlace place{tick, reader.get<std::uint64_t>()};
    const bool ascends =
        places.empty() || (places.back().tick <= place.tick && places.back().offset < place.offset);
    if (!ascends || place.offset >= chunk_offset)
      return malformed(position, "entries out of order");
    places.push_back(place);
  }
  if (reader.get<std::uint64_t>() == chunk_offset) return {};
  return malformed(payload.size() - sizeof(std::uint64_t), "names another place as its own");
}

}  // namespace lockstone::replay
