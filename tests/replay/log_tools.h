// Records toy matches, and takes logs apart and puts them together again with right checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <lockstone/replay/recorder.h>
#include <lockstone/replay/verifier.h>

#include "replay/codec/header_codec.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::test {

using namespace toy;

using Bytes = std::vector<std::byte>;

/// A match to be recorded.
struct ToyMatch {
  ToyConfig config{.body_count = 4};
  std::uint64_t ticks = 20;
  std::uint64_t start_tick = 0;  ///< ticks before it are played and not recorded
  std::uint32_t keyframe_interval = 8;
  std::uint32_t chunk_ticks = 5;
  bool finishes = true;  ///< false: the recorder stops at the last flush
  bool has_events = true;
  std::uint64_t command_every = 0;  ///< ticks between those with commands; 0: there are none
  std::size_t command_bytes = 20;   ///< of each but the server's
  bool compress = false;
  bool index = false;
  std::optional<replay::SigningKey> signing_key = std::nullopt;
  std::optional<std::uint64_t> flip_at = std::nullopt;  ///< flip a state bit after this tick's step
};

/// Inputs of the match's players at `tick`; every origin occurs.
class ToyInputs {
 public:
  explicit ToyInputs(const ToyConfig& config);

  [[nodiscard]] std::span<const PlayerInput> at(std::uint64_t tick);

 private:
  ToyConfig config_;
  Bytes bytes_;
  std::vector<PlayerInput> inputs_;
};

/// The commands of a tick of the match: of a player, and every other time one of the server's.
class ToyCommands {
 public:
  explicit ToyCommands(const ToyMatch& match) : match_(match) {}
  [[nodiscard]] std::span<const PlayerCommand> at(std::uint64_t tick);

 private:
  const ToyMatch& match_;
  Bytes bytes_;
  std::vector<PlayerCommand> commands_;
};

/// Plays and records. Returns the recorder's first bad status.
Status record(const ToyMatch& match, replay::Sink& sink);

/// The same into memory.
[[nodiscard]] Bytes record(const ToyMatch& match);

/// Where a chunk stands in a log.
struct ChunkPlace {
  std::size_t offset = 0;
  std::size_t bytes = 0;  ///< with its frame
  replay::ChunkFrame frame;

  [[nodiscard]] std::size_t end() const { return offset + bytes; }
};

/// The chunks of a good log.
[[nodiscard]] std::vector<ChunkPlace> chunks_of(const Bytes& log);

/// Index of the `nth` chunk of a type.
[[nodiscard]] std::size_t find_chunk(const std::vector<ChunkPlace>& chunks, replay::ChunkType type,
                                     std::size_t nth = 0);

/// Rewrites sequence numbers, the chain and all checksums from the payloads as they are now.
void relink(Bytes& log);

/// Writes one chunk's frame again with a right checksum; the chunks after it are left as they are.
void set_frame(Bytes& log, const ChunkPlace& place, const replay::ChunkFrame& frame);

/// Records a log again through the Recorder, with inputs altered by `alter` and all else as it was:
/// the checksums are right, the hashes are those of the old inputs.
using AlterInput = std::function<void(std::uint64_t tick, std::size_t slot, std::span<std::byte>)>;
[[nodiscard]] Bytes rewrite(const Bytes& log, const AlterInput& alter);

/// verify() with the toy.
[[nodiscard]] replay::VerifyReport verify_toy(const Bytes& log,
                                              const replay::VerifyOptions& options = {});

}  // namespace lockstone::test
