// A native snapshot as its differences from another one, the base.
//
//   header of the new state, then for each store
//     without keys: one bit for each new record, set when the record follows and is not the base's
//       of the same index; the records
//     with keys: one bit for each record of the base, set when it is kept; u32 count of new
//     records;
//       these, by key
//
// Bits fill bytes from the lowest up. As native as a native snapshot: this build, this process.
#pragma once

#include <algorithm>
#include <cstring>

#include <lockstone/status.h>

#include "core/world/state/stores.h"

namespace lockstone {

/// A native snapshot as bytes, read record by record.
template <class List>
struct NativeState {
  WorldHeader header;
  StoredRecords<List> records;

  /// truncated or malformed when these are not the bytes of one.
  static Result<NativeState> open(ByteView bytes, const WorldDef& def) {
    NativeState state;
    if (bytes.size() < sizeof(WorldHeader)) return Status::truncated;
    std::memcpy(&state.header, bytes.data(), sizeof(WorldHeader));
    if (!List::fits(state.header, def)) return Status::malformed;
    const ByteView rest = bytes.subspan(sizeof(WorldHeader));
    if (rest.size() != List::record_bytes(state.header)) return Status::truncated;
    state.records = StoredRecords<List>(state.header, rest);
    return state;
  }

  template <class Store>
  void read(std::uint32_t index, typename Store::Record& record) const {
    const ByteView bytes = records.template bytes_of<Store>();
    std::memcpy(&record, bytes.data() + index * sizeof(record), sizeof(record));
  }
};

[[nodiscard]] constexpr std::size_t bitmap_bytes(std::uint32_t count) {
  return (std::size_t{count} + 7) / 8;
}

/// The most bytes that a delta may take beyond a snapshot.
template <class List>
[[nodiscard]] std::size_t delta_overhead(const WorldDef& def) {
  std::size_t bytes = 0;
  List::for_each([&](auto store) {
    bytes += bitmap_bytes(capacity_of<decltype(store)>(def)) + sizeof(std::uint32_t);
  });
  return bytes;
}

/// Memory to fill from the front; stops for good once something does not fit.
class RawWriter {
 public:
  explicit RawWriter(std::span<std::byte> out) : out_(out) {}

  void put(const void* from, std::size_t bytes) {
    if (std::byte* to = skip(bytes); to != nullptr) std::memcpy(to, from, bytes);
  }
  /// Zeros, to be filled in later; null when there is no room.
  std::byte* put_zeros(std::size_t bytes) {
    std::byte* to = skip(bytes);
    if (to != nullptr) std::fill_n(to, bytes, std::byte{0});
    return to;
  }
  [[nodiscard]] std::size_t size() const { return is_full_ ? 0 : size_; }

 private:
  std::byte* skip(std::size_t bytes) {
    is_full_ = is_full_ || bytes > out_.size() - size_;
    if (is_full_) return nullptr;
    size_ += bytes;
    return out_.data() + size_ - bytes;
  }

  std::span<std::byte> out_;
  std::size_t size_ = 0;
  bool is_full_ = false;
};

inline void set_bit(std::byte* bits, std::uint32_t index) {
  bits[index / 8] |= static_cast<std::byte>(1U << (index % 8));
}
[[nodiscard]] inline bool has_bit(const std::byte* bits, std::uint32_t index) {
  return (std::to_integer<unsigned>(bits[index / 8]) >> (index % 8) & 1U) != 0;
}

template <class Store, class List, class State>
void write_changed_records(const State& state, const NativeState<List>& base, RawWriter& to) {
  using Record = typename Store::Record;
  const std::uint32_t known = base.header.*Store::k_count;
  const ByteView old = base.records.template bytes_of<Store>();
  std::byte* bits = to.put_zeros(bitmap_bytes(state.header.*Store::k_count));
  for_each_record<Store>(state, [&](std::uint32_t index, const Record& record) {
    if (bits == nullptr) return;
    const std::byte* before = old.data() + index * sizeof(Record);
    if (index < known && std::memcmp(before, &record, sizeof(Record)) == 0) return;
    set_bit(bits, index);
    to.put(&record, sizeof(Record));
  });
}

// Both sides are sorted by key.
template <class Store, class List, class State>
void write_new_records(const State& state, const NativeState<List>& base, RawWriter& to) {
  using Record = typename Store::Record;
  const std::uint32_t known = base.header.*Store::k_count;
  std::byte* bits = to.put_zeros(bitmap_bytes(known));
  std::byte* count_at = to.put_zeros(sizeof(std::uint32_t));
  if (bits == nullptr || count_at == nullptr) return;
  std::uint32_t at = 0, count = 0;
  Record old;
  const auto read_old = [&] {
    if (at < known) base.template read<Store>(at, old);
  };
  read_old();
  for_each_record<Store>(state, [&](std::uint32_t, const Record& record) {
    for (; at < known && old.key() < record.key(); read_old())
      ++at;
    if (at < known && std::memcmp(&old, &record, sizeof(Record)) == 0) return set_bit(bits, at);
    to.put(&record, sizeof(Record));
    ++count;
  });
  std::memcpy(count_at, &count, sizeof(count));
}

/// Returns the bytes written; 0 when `base` is no native snapshot or `out` is too small.
template <class List, class State>
[[nodiscard]] std::size_t write_delta(const State& state, ByteView base_bytes,
                                      std::span<std::byte> out) {
  const Result<NativeState<List>> base = NativeState<List>::open(base_bytes, state.def);
  if (!base.ok()) return 0;
  RawWriter to(out);
  to.put(&state.header, sizeof(WorldHeader));
  List::for_each([&](auto store) {
    using Store = decltype(store);
    if constexpr (Store::k_has_key) {
      write_new_records<Store>(state, base.value(), to);
    } else {
      write_changed_records<Store>(state, base.value(), to);
    }
  });
  return to.size();
}

/// The new state, read from base and delta together: each store's records once, in order.
template <class List>
class DeltaState {
 public:
  WorldHeader header;

  static Result<DeltaState> open(ByteView base_bytes, ByteView delta, const WorldDef& def) {
    const Result<NativeState<List>> base = NativeState<List>::open(base_bytes, def);
    if (!base.ok()) return base.status();
    DeltaState state;
    state.base_ = base.value();
    state.rest_ = delta;
    if (!state.take(&state.header, sizeof(WorldHeader))) return Status::truncated;
    if (!List::fits(state.header, def)) return Status::malformed;
    bool good = true;
    List::for_each([&](auto store) { good = good && state.template find<decltype(store)>(); });
    if (!good || !state.rest_.empty()) return Status::truncated;
    return state;
  }

  template <class Store>
  void read(std::uint32_t index, typename Store::Record& record) {
    Part& part = parts_[List::template index_of<Store>()];
    if constexpr (Store::k_has_key) {
      return merge<Store>(part, record);
    } else if (!has_bit(part.bits.data(), index)) {
      return base_.template read<Store>(index, record);
    }
    copy(part.records, record);
  }

 private:
  struct Part {
    ByteView bits;
    ByteView records;        // that are not the base's; those not yet read
    std::uint32_t next = 0;  // with keys: record of the base
  };

  template <class Record>
  static void copy(ByteView& from, Record& record) {
    std::memcpy(&record, from.data(), sizeof(record));
    from = from.subspan(sizeof(record));
  }

  bool take(void* to, std::size_t bytes) {
    if (rest_.size() < bytes) return false;
    std::memcpy(to, rest_.data(), bytes);
    rest_ = rest_.subspan(bytes);
    return true;
  }
  bool take(ByteView& part, std::size_t bytes) {
    if (rest_.size() < bytes) return false;
    part = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return true;
  }

  // The counts must add up: kept and new records are all records.
  template <class Store>
  bool find() {
    Part& part = parts_[List::template index_of<Store>()];
    const std::uint32_t known = base_.header.*Store::k_count, count = header.*Store::k_count;
    const std::uint32_t places = Store::k_has_key ? known : count;
    if (!take(part.bits, bitmap_bytes(places))) return false;
    std::uint32_t set = 0, fresh = 0;
    for (std::uint32_t i = 0; i < places; ++i) {
      const bool bit = has_bit(part.bits.data(), i);
      if (!Store::k_has_key && !bit && i >= known) return false;
      set += bit ? 1U : 0U;
    }
    fresh = set;
    if (Store::k_has_key && (!take(&fresh, sizeof(fresh)) || count != set + fresh)) return false;
    return take(part.records, fresh * sizeof(typename Store::Record));
  }

  template <class Store>
  void merge(Part& part, typename Store::Record& record) {
    const std::uint32_t known = base_.header.*Store::k_count;
    while (part.next < known && !has_bit(part.bits.data(), part.next))
      ++part.next;
    typename Store::Record kept, fresh;
    if (part.next < known) base_.template read<Store>(part.next, kept);
    if (!part.records.empty()) std::memcpy(&fresh, part.records.data(), sizeof(fresh));
    const bool take_kept = part.records.empty() || (part.next < known && kept.key() < fresh.key());
    record = take_kept ? kept : fresh;
    if (take_kept) {
      ++part.next;
    } else {
      part.records = part.records.subspan(sizeof(fresh));
    }
  }

  NativeState<List> base_;
  ByteView rest_;
  Part parts_[List::k_size];
};

}  // namespace lockstone
