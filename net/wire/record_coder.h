// Codes a run of equally long records, each as its difference from the one before.
//
// The record before the first is all zero. A control byte 0x00 … 0x7f says that 1 … 128 records
// equal their predecessor. 0x80 says that one record differs: a bit mask follows (byte i / 8, bit
// i % 8, for record byte i), then the new values of the marked bytes. 0x81 says that one record
// differs and follows as a whole. Other bytes are malformed.
#pragma once

#include <array>
#include <cstddef>

#include <lockstone/bytes.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

class RecordWriter {
 public:
  /// `record_bytes` is in 1 … k_max_record_bytes; `out` outlives the writer.
  RecordWriter(std::span<std::byte> out, std::size_t record_bytes)
      : out_(out), record_bytes_(record_bytes) {}

  /// Appends a record. False, and nothing changes, when it does not fit.
  bool add(ByteView record);

  [[nodiscard]] ByteView written() const { return out_.first(size_); }

 private:
  bool add_equal();
  bool add_changed(ByteView record, std::size_t changed_count);
  bool add_whole(ByteView record);

  std::span<std::byte> out_;
  std::size_t record_bytes_;
  std::size_t size_ = 0;
  std::size_t run_at_ = 0;  ///< where the open run's control byte is
  bool run_open_ = false;
  std::array<std::byte, k_max_record_bytes> last_{};
};

class RecordReader {
 public:
  RecordReader(ByteView coded, std::size_t record_bytes)
      : reader_(coded), record_bytes_(record_bytes) {}

  /// Steps to the next record. False at a malformed or missing one.
  bool next();

  /// The current record; valid until the next call of `next`.
  [[nodiscard]] ByteView record() const { return ByteView(last_).first(record_bytes_); }

  /// Whether all bytes were used and no run promises further records.
  [[nodiscard]] bool at_end() const { return reader_.remaining() == 0 && run_left_ == 0; }

 private:
  bool read_changed();
  bool read_whole();

  ByteReader reader_;
  std::size_t record_bytes_;
  std::size_t run_left_ = 0;
  std::array<std::byte, k_max_record_bytes> last_{};
};

}  // namespace lockstone::net
