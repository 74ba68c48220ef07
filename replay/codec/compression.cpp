#include "replay/codec/compression.h"

#if defined(LOCKSTONE_WITH_ZSTD)
#include <zstd.h>
#endif

namespace lockstone::replay {

#if defined(LOCKSTONE_WITH_ZSTD)
namespace {

// Keyframes are written while the game runs, so a fast level.
constexpr int k_level = 3;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

struct Compressor::Parts {
  std::unique_ptr<ZSTD_CCtx, FreeContext> context{ZSTD_createCCtx()};
  std::vector<std::byte> chunk;

  std::span<std::byte> run(ByteView raw) {
    if (context == nullptr) return {};
    const std::span<std::byte> stored = std::span(chunk).subspan(k_chunk_header_bytes);
    const std::size_t bytes = ZSTD_compressCCtx(context.get(), stored.data(), stored.size(),
                                                raw.data(), raw.size(), k_level);
    if (ZSTD_isError(bytes) != 0U || bytes >= raw.size()) return {};
    if (!within_ratio(bytes, raw.size())) return {};
    return std::span(chunk).first(k_chunk_header_bytes + bytes);
  }
};

Compressor::Compressor(std::size_t raw_bytes_max) : parts_(std::make_unique<Parts>()) {
  parts_->chunk.resize(k_chunk_header_bytes + ZSTD_compressBound(raw_bytes_max));
  // The library keeps the memory of its largest input for later ones.
  const std::vector<std::byte> largest(raw_bytes_max);
  static_cast<void>(parts_->run(largest));
}

std::span<std::byte> Compressor::compress(ByteView raw) {
  return parts_->run(raw);
}

DecodeFault decompress(ByteView stored, std::uint32_t raw_bytes, std::vector<std::byte>& raw) {
  if (!within_ratio(stored.size(), raw_bytes)) {
    return malformed(0, "announces more bytes than its stored ones may stand for");
  }
  if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != raw_bytes) {
    return malformed(0, "no Zstandard frame of the announced length");
  }
  raw.resize(raw_bytes);
  const std::size_t bytes = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
  if (ZSTD_isError(bytes) != 0U || bytes != raw.size()) {
    return malformed(0, "a damaged Zstandard frame");
  }
  return {};
}

bool compression_available() {
  return true;
}
#else
struct Compressor::Parts {};

Compressor::Compressor(std::size_t) {}

std::span<std::byte> Compressor::compress(ByteView) {
  return {};
}

DecodeFault decompress(ByteView, std::uint32_t, std::vector<std::byte>&) {
  return {Status::unsupported_version, 0, "compressed, and this build has no Zstandard"};
}

bool compression_available() {
  return false;
}
#endif

Compressor::~Compressor() = default;

}  // namespace lockstone::replay
