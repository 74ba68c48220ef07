// The first pairs, in order, of however many are found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/collision/broad_phase/pair.h"

namespace lockstone {

class PairList {
 public:
  explicit PairList(std::size_t capacity) : capacity_(capacity) { pairs_.reserve(capacity); }

  void clear() {
    pairs_.clear();
    overflowed_ = false;
  }

  /// For pairs that come in order. False when the list is full: later pairs are left out.
  bool append(const Pair& pair) {
    if (pairs_.size() == capacity_) {
      overflowed_ = true;
      return false;
    }
    pairs_.push_back(pair);
    return true;
  }

  /// For as many pairs in order, to be written by the caller: of a cleared list, as far as it goes.
  [[nodiscard]] std::span<Pair> make_room(std::size_t count) {
    overflowed_ = count > capacity_;
    pairs_.resize(std::min(count, capacity_));
    return pairs_;
  }

  /// For pairs in any order, with `sort` after the last. Once full, the list is a heap whose front
  /// is the last pair in order, the first to go.
  void offer(const Pair& pair) {
    LKS_ASSERT(pair.a != pair.b);
    if (pairs_.size() < capacity_) {
      pairs_.push_back(pair);
      return;
    }
    if (!overflowed_) std::make_heap(pairs_.begin(), pairs_.end());
    overflowed_ = true;
    LKS_ASSERT(pairs_.size() == capacity_);
    if (pair > pairs_.front()) return;
    std::pop_heap(pairs_.begin(), pairs_.end());
    pairs_.back() = pair;
    std::push_heap(pairs_.begin(), pairs_.end());
  }

  void sort() { std::sort(pairs_.begin(), pairs_.end()); }

  [[nodiscard]] bool overflowed() const { return overflowed_; }
  [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }

 private:
  std::vector<Pair> pairs_;
  std::size_t capacity_;
  bool overflowed_ = false;
};

}  // namespace lockstone
