#include "net/wire/record_coder.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::byte k_changed{0x80};
constexpr std::byte k_whole{0x81};
constexpr std::size_t k_max_run = 128;

std::size_t mask_bytes(std::size_t record_bytes) {
  return (record_bytes + 7) / 8;
}

bool marked(ByteView mask, std::size_t i) {
  return ((mask[i / 8] >> (i % 8)) & std::byte{1}) != std::byte{0};
}

}  // namespace

bool RecordWriter::add(ByteView record) {
  LKS_CHECK(record.size() == record_bytes_ && record_bytes_ <= last_.size());
  std::size_t changed_count = 0;
  for (std::size_t i = 0; i < record_bytes_; ++i)
    changed_count += record[i] != last_[i] ? 1U : 0U;
  return changed_count == 0 ? add_equal() : add_changed(record, changed_count);
}

bool RecordWriter::add_equal() {
  if (run_open_ && std::to_integer<std::size_t>(out_[run_at_]) + 1 < k_max_run) {
    out_[run_at_] = static_cast<std::byte>(std::to_integer<unsigned>(out_[run_at_]) + 1);
    return true;
  }
  if (size_ == out_.size()) return false;
  run_at_ = size_;
  run_open_ = true;
  out_[size_++] = std::byte{0};
  return true;
}

bool RecordWriter::add_changed(ByteView record, std::size_t changed_count) {
  const std::size_t needed_bytes = 1 + mask_bytes(record_bytes_) + changed_count;
  if (needed_bytes > 1 + record_bytes_) return add_whole(record);
  if (out_.size() - size_ < needed_bytes) return false;
  out_[size_++] = k_changed;
  const std::span<std::byte> mask = out_.subspan(size_, mask_bytes(record_bytes_));
  std::fill(mask.begin(), mask.end(), std::byte{0});
  size_ += mask.size();
  for (std::size_t i = 0; i < record_bytes_; ++i) {
    if (record[i] == last_[i]) continue;
    mask[i / 8] |= std::byte{1} << (i % 8);
    out_[size_++] = record[i];
    last_[i] = record[i];
  }
  run_open_ = false;
  return true;
}

bool RecordWriter::add_whole(ByteView record) {
  if (out_.size() - size_ < 1 + record_bytes_) return false;
  out_[size_++] = k_whole;
  std::copy(record.begin(), record.end(), out_.subspan(size_).begin());
  std::copy(record.begin(), record.end(), last_.begin());
  size_ += record_bytes_;
  run_open_ = false;
  return true;
}

bool RecordReader::next() {
  if (run_left_ == 0) {
    if (reader_.remaining() == 0) return false;
    const auto control = reader_.get<std::uint8_t>();
    if (std::byte{control} == k_changed) return read_changed();
    if (std::byte{control} == k_whole) return read_whole();
    if (control >= k_max_run) return false;
    run_left_ = std::size_t{control} + 1;
  }
  --run_left_;
  return true;
}

bool RecordReader::read_whole() {
  const ByteView record = reader_.get_bytes(record_bytes_);
  if (!reader_.ok() || std::equal(record.begin(), record.end(), last_.begin())) return false;
  std::copy(record.begin(), record.end(), last_.begin());
  return true;
}

bool RecordReader::read_changed() {
  const ByteView mask = reader_.get_bytes(mask_bytes(record_bytes_));
  if (!reader_.ok()) return false;
  std::size_t changed_count = 0;
  for (std::size_t i = 0; i < mask.size() * 8; ++i) {
    if (!marked(mask, i)) continue;
    if (i >= record_bytes_) return false;
    ++changed_count;
    last_[i] = static_cast<std::byte>(reader_.get<std::uint8_t>());
  }
  return reader_.ok() && changed_count > 0;
}

}  // namespace lockstone::net
