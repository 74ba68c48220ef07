#include "core/collision/candidate_pairs.h"

#include <algorithm>

namespace lockstone {

CandidatePairs::CandidatePairs(std::uint32_t body_capacity, std::size_t capacity)
    : first_note_(body_capacity, k_null), capacity_(capacity) {
  rows_.reserve(body_capacity);
  next_rows_.reserve(body_capacity);
  partners_.reserve(capacity);
  next_partners_.reserve(capacity);
  notes_.reserve(capacity);
}

void CandidatePairs::clear() {
  rows_.clear();
  partners_.clear();
  notes_.clear();
  std::fill(first_note_.begin(), first_note_.end(), k_null);
}

bool CandidatePairs::add(const Pair& pair) {
  if (notes_.size() == capacity_) return false;
  notes_.push_back({pair.b, first_note_[pair.a]});
  first_note_[pair.a] = static_cast<std::uint32_t>(notes_.size() - 1);
  return true;
}

bool CandidatePairs::merge(std::span<const std::uint8_t> is_touched) {
  next_rows_.clear();
  next_partners_.clear();
  std::size_t old = 0, begin = 0;
  for (std::uint32_t body = 0; body < is_touched.size(); ++body) {
    const std::size_t size = next_partners_.size();
    if (old < rows_.size() && rows_[old].body == body) {
      if (is_touched[body] == 0) keep(begin, rows_[old].end, is_touched);
      begin = rows_[old++].end;
    }
    if (first_note_[body] != k_null) {
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
  rows_.swap(next_rows_);
  partners_.swap(next_partners_);
  return true;
}

void CandidatePairs::keep(std::size_t begin, std::size_t end,
                          std::span<const std::uint8_t> is_touched) {
  for (std::size_t i = begin; i < end && next_partners_.size() < capacity_; ++i) {
    if (is_touched[partners_[i]] == 0) next_partners_.push_back(partners_[i]);
  }
}

void CandidatePairs::take_notes(std::uint32_t body) {
  for (std::uint32_t i = first_note_[body]; i != k_null && next_partners_.size() < capacity_;
       i = notes_[i].next) {
    next_partners_.push_back(notes_[i].partner);
  }
  first_note_[body] = k_null;
}

}  // namespace lockstone
