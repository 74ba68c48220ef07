// The pairs that may overlap as long as no body leaves its fat box: rows of partners by body, kept
// from tick to tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/broad_phase/pair.h"

namespace lockstone {

class CandidatePairs {
 public:
  CandidatePairs(std::uint32_t body_capacity, std::size_t capacity);

  void clear();

  /// Notes a new pair for the next `merge`. False when there is no room.
  bool add(const Pair& pair);

  /// Drops every pair with a touched body and takes in the noted ones. False when they do not fit:
  /// then nothing is kept.
  bool merge(std::span<const std::uint8_t> is_touched);

  /// Bodies that have partners, ascending, and these, ascending too.
  [[nodiscard]] std::uint32_t row_count() const { return static_cast<std::uint32_t>(rows_.size()); }
  [[nodiscard]] std::uint32_t body(std::uint32_t row) const { return rows_[row].body; }
  [[nodiscard]] std::span<const std::uint32_t> partners(std::uint32_t row) const {
    const std::uint32_t begin = row == 0 ? 0 : rows_[row - 1].end;
    return std::span(partners_).subspan(begin, rows_[row].end - begin);
  }

  /// Calls `visit(a, partners)` for every body that has partners, bodies and partners ascending.
  template <class Visit>
  void for_each(Visit&& visit) const {
    std::size_t begin = 0;
    for (const Row& row : rows_) {
      visit(row.body, std::span(partners_).subspan(begin, row.end - begin));
      begin = row.end;
    }
  }

 private:
  static constexpr std::uint32_t k_null = 0xffffffff;

  struct Row {
    std::uint32_t body = 0;
    std::uint32_t end = 0;  // in partners_; it begins where the row before ends
  };
  struct Note {
    std::uint32_t partner = 0;
    std::uint32_t next = k_null;  // of the same body
  };

  void keep(std::size_t begin, std::size_t end, std::span<const std::uint8_t> is_touched);
  void take_notes(std::uint32_t body);

  std::vector<Row> rows_, next_rows_;
  std::vector<std::uint32_t> partners_, next_partners_;
  std::vector<Note> notes_;
  std::vector<std::uint32_t> noted_;       // bodies that have notes
  std::vector<std::uint32_t> first_note_;  // by body
  std::size_t capacity_;
};

}  // namespace lockstone
