#include "core/collision/broad_phase/candidate_pairs.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {

CandidatePairs::CandidatePairs(std::uint32_t body_capacity, std::size_t capacity)
    : first_note_(body_capacity, k_null), capacity_(capacity) {
  rows_.reserve(body_capacity);
  next_rows_.reserve(body_capacity);
  partners_.reserve(capacity);
  next_partners_.reserve(capacity);
  notes_.reserve(capacity);
  noted_.reserve(body_capacity);
}

void CandidatePairs::clear() {
  rows_.clear();
  partners_.clear();
  notes_.clear();
  noted_.clear();
  std::fill(first_note_.begin(), first_note_.end(), k_null);
}

bool CandidatePairs::add(const Pair& pair) {
  LKS_ASSERT(pair.a != pair.b && pair.a < first_note_.size());
  if (notes_.size() == capacity_) return false;
  if (first_note_[pair.a] == k_null) noted_.push_back(pair.a);
  notes_.push_back({pair.b, first_note_[pair.a]});
  first_note_[pair.a] = static_cast<std::uint32_t>(notes_.size() - 1);
  return true;
}

// Rows and noted bodies are both in order, so that one pass over the two makes the new rows: bodies
// without partners cost nothing.
bool CandidatePairs::merge(std::span<const std::uint8_t> is_touched) {
  std::sort(noted_.begin(), noted_.end());
  next_rows_.clear();
  next_partners_.clear();
  std::size_t old = 0, note = 0, begin = 0;
  while (old < rows_.size() || note < noted_.size()) {
    const std::uint32_t of_row = old < rows_.size() ? rows_[old].body : k_null;
    const std::uint32_t of_note = note < noted_.size() ? noted_[note] : k_null;
    const std::uint32_t body = std::min(of_row, of_note);
    const std::size_t size = next_partners_.size();
    LKS_ASSERT(body != k_null);
    if (body == of_row) {
      if (is_touched[body] == 0) keep(begin, rows_[old].end, is_touched);
      begin = rows_[old++].end;
    }
    if (body == of_note) {
      ++note;
      take_notes(body);
      std::sort(next_partners_.begin() + static_cast<std::ptrdiff_t>(size), next_partners_.end());
    }
    if (next_partners_.size() == capacity_) {
      clear();
      return false;
    }
    if (next_partners_.size() > size) {
      next_rows_.push_back({body, static_cast<std::uint32_t>(next_partners_.size())});
    }
  }
  notes_.clear();
  noted_.clear();
  rows_.swap(next_rows_);
  partners_.swap(next_partners_);
  return true;
}

void CandidatePairs::keep(std::size_t begin, std::size_t end,
                          std::span<const std::uint8_t> is_touched) {
  LKS_ASSERT(begin <= end && end <= partners_.size());
  for (std::size_t i = begin; i < end && next_partners_.size() < capacity_; ++i) {
    if (is_touched[partners_[i]] == 0) next_partners_.push_back(partners_[i]);
  }
}

void CandidatePairs::take_notes(std::uint32_t body) {
  LKS_ASSERT(first_note_[body] != k_null);
  for (std::uint32_t i = first_note_[body]; i != k_null && next_partners_.size() < capacity_;
       i = notes_[i].next) {
    next_partners_.push_back(notes_[i].partner);
  }
  first_note_[body] = k_null;
}

}  // namespace lockstone
