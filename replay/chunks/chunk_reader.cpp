#include "replay/chunks/chunk_reader.h"

#include <array>
#include <utility>

#include "replay/codec/compression.h"

namespace lockstone::replay {

namespace {

DecodeFault check_bounds(const ChunkHeader& chunk, const SimulationInfo& info,
                         std::size_t snapshot_bytes_max) {
  if (chunk.type == ChunkType::keyframe &&
      chunk.raw_bytes > sizeof(std::uint64_t) + snapshot_bytes_max) {
    return malformed(24, "a snapshot longer than any of this simulation");
  }
  return check_bounds(chunk, info);
}

}  // namespace

Walk ChunkReader::open() {
  std::array<std::byte, k_max_file_header_bytes> buffer{};
  const std::uint64_t size = source_.size();
  const auto truncated = [&] {
    return reject_file(
        {Status::truncated, static_cast<std::size_t>(size), "ends inside the file header"});
  };
  if (size < k_file_prefix_bytes) return truncated();
  const std::span<std::byte> prefix = std::span(buffer).first(k_file_prefix_bytes);
  if (source_.read_at(0, prefix) != Status::ok) return read_error();
  std::size_t header_bytes = 0;
  DecodeFault fault = decode_file_prefix(prefix, header_bytes);
  if (!fault.ok()) return reject_file(fault);
  if (size < header_bytes) return truncated();
  const std::span<std::byte> header = std::span(buffer).first(header_bytes);
  if (source_.read_at(0, header) != Status::ok) return read_error();
  std::uint64_t checksum = 0;
  fault = decode_file_header(header, log_, checksum);
  if (!fault.ok()) return reject_file(fault);
  chain_.begin(header_bytes, checksum);
  return Walk::good;
}

Walk ChunkReader::next_frame() {
  chunk_offset_ = next_offset();
  frame_ = {};
  if (remaining() == 0) return Walk::finished;
  if (remaining() < k_chunk_header_bytes) {
    return torn(ChunkType::none, "the log ends inside the frame of a chunk");
  }
  std::array<std::byte, k_chunk_header_bytes> bytes{};
  if (source_.read_at(chunk_offset_, bytes) != Status::ok) return read_error();
  DecodeFault fault = decode_chunk_frame(bytes, frame_);
  if (fault.ok()) fault = check_bounds(frame_.header, log_.info, snapshot_bytes_max_);
  if (fault.status == Status::checksum_mismatch) {
    // The type in a damaged frame may be the damage, so it is not named.
    frame_.header.type = ChunkType::none;
    return reject(Status::checksum_mismatch, "frame of " + name_chunk() + ": " + fault.what);
  }
  if (!fault.ok()) return reject(fault.status, "frame of " + name_chunk() + ": " + fault.what);
  return check_place();
}

Status ChunkReader::jump(std::uint64_t offset) {
  if (offset > source_.size()) return Status::malformed;
  chain_.jump(offset);
  return Status::ok;
}

Walk ChunkReader::check_place() {
  if (const auto broken = chain_.check(frame_, name_chunk())) {
    return reject(broken->status, broken->reason);
  }
  if (remaining() - k_chunk_header_bytes < frame_.header.stored_bytes) {
    return torn(frame_.header.type, "the log ends inside " + name_chunk());
  }
  chain_.advance(frame_);
  return Walk::good;
}

Walk ChunkReader::read_payload() {
  payload_.resize(frame_.header.stored_bytes);
  const std::uint64_t offset = chunk_offset_ + k_chunk_header_bytes;
  if (source_.read_at(offset, payload_) != Status::ok) return read_error();
  if (payload_checksum(payload_) == frame_.payload_checksum) return Walk::good;
  return reject(Status::checksum_mismatch, "payload of " + name_chunk() + ": wrong checksum");
}

Walk ChunkReader::unpack() {
  if (frame_.header.codec == Codec::raw) return Walk::good;
  const DecodeFault fault = decompress(payload_, frame_.header.raw_bytes, unpacked_);
  if (!fault.ok()) {
    reject_payload(fault);
    return Walk::damaged;
  }
  std::swap(payload_, unpacked_);
  return Walk::good;
}

std::string ChunkReader::name_chunk() const {
  const ChunkHeader& header = frame_.header;
  if (header.type == ChunkType::none) return "chunk " + std::to_string(chain_.next_sequence());
  std::string name(to_string(header.type));
  name +=
      " chunk " + std::to_string(header.sequence) + " (tick " + std::to_string(header.first_tick);
  if (header.count > 1 && header.type != ChunkType::event) {
    name += " to " + std::to_string(header.first_tick + header.count - 1);
  }
  return name + ')';
}

void ChunkReader::reject_payload(const DecodeFault& fault) {
  report(Walk::damaged, {fault.status, chunk_offset_ + k_chunk_header_bytes + fault.position,
                         frame_.header.type, name_chunk() + ": " + fault.what});
}

void ChunkReader::reject_chunk(Status status, const char* what) {
  reject(status, name_chunk() + ": " + what);
}

void ChunkReader::reject_rest() {
  report(Walk::damaged,
         {Status::malformed, chunk_offset_, ChunkType::none, "bytes after the end of the log"});
}

Walk ChunkReader::reject(Status status, std::string what) {
  return report(Walk::damaged, {status, chunk_offset_, frame_.header.type, std::move(what)});
}

Walk ChunkReader::reject_file(const DecodeFault& fault) {
  return report(Walk::damaged, {fault.status, fault.position, ChunkType::none, fault.what});
}

Walk ChunkReader::torn(ChunkType type, std::string what) {
  return report(Walk::torn, {Status::truncated, chunk_offset_, type, std::move(what)});
}

Walk ChunkReader::read_error() {
  return reject(Status::io_error, "the system refuses to read the log");
}

Walk ChunkReader::report(Walk walk, Damage damage) {
  damage_ = std::move(damage);
  return walk;
}

}  // namespace lockstone::replay
