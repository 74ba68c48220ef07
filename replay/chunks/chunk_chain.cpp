#include "replay/chunks/chunk_chain.h"

namespace lockstone::replay {

void ChunkChain::begin(std::uint64_t offset, std::uint64_t checksum) {
  offset_ = offset;
  checksum_ = checksum;
}

void ChunkChain::jump(std::uint64_t offset) {
  offset_ = offset;
  jumped_ = true;
}

std::optional<ChunkChain::Break> ChunkChain::check(const ChunkFrame& frame,
                                                   const std::string& name) {
  if (jumped_) {
    sequence_ = frame.header.sequence;
    checksum_ = frame.previous;
    jumped_ = false;
  }
  if (frame.header.sequence != sequence_) {
    return Break{Status::malformed, "chunk " + std::to_string(frame.header.sequence) +
                                        " stands where chunk " + std::to_string(sequence_) +
                                        " belongs: chunks are missing, repeated or out of order"};
  }
  if (frame.previous != checksum_) {
    return Break{Status::checksum_mismatch,
                 name + " does not follow the chunk before it: it is from another log"};
  }
  return std::nullopt;
}

void ChunkChain::advance(const ChunkFrame& frame) {
  checksum_ = frame.checksum;
  ++sequence_;
  offset_ += k_chunk_header_bytes + frame.header.stored_bytes;
}

}  // namespace lockstone::replay
