// A set of body indices that can be listed in order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lockstone {

class IndexSet {
 public:
  /// No function but this allocates.
  explicit IndexSet(std::uint32_t capacity) : words_((std::size_t{capacity} + 63) / 64) {
    list_.reserve(capacity);
  }

  [[nodiscard]] bool has(std::uint32_t index) const {
    return ((words_[index / 64] >> (index % 64)) & 1U) != 0;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

  void insert(std::uint32_t index) {
    if (!has(index)) flip(index);
  }
  void erase(std::uint32_t index) {
    if (has(index)) flip(index);
  }

  /// Inserts an index that is absent, removes one that is present.
  void flip(std::uint32_t index) {
    words_[index / 64] ^= std::uint64_t{1} << (index % 64);
    count_ = has(index) ? count_ + 1 : count_ - 1;
    used_words_ = std::max(used_words_, std::size_t{index} / 64 + 1);
    is_listed_ = false;
  }

  void clear() {
    std::fill_n(words_.begin(), used_words_, std::uint64_t{0});
    used_words_ = count_ = 0;
    list_.clear();
    is_listed_ = true;
  }

  /// Ascending; valid until the next call after a change.
  [[nodiscard]] std::span<const std::uint32_t> list() {
    if (is_listed_) return list_;
    list_.clear();
    for (std::size_t word = 0; word < used_words_; ++word) {
      for (std::uint64_t rest = words_[word]; rest != 0; rest &= rest - 1) {
        list_.push_back(static_cast<std::uint32_t>(word * 64) +
                        static_cast<std::uint32_t>(std::countr_zero(rest)));
      }
    }
    is_listed_ = true;
    return list_;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t used_words_ = 0;  // none beyond holds a bit
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> list_;
  bool is_listed_ = true;
};

}  // namespace lockstone
