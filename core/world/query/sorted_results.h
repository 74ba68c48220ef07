// Results of queries, kept in their canonical order while they are found in any.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

namespace lockstone {

/// Keeps the first `out.size()` items in their order, whatever the order they come in.
template <class T, class Before>
void insert_sorted(const T& item, std::span<T> out, std::size_t& count, Before&& before) {
  if (out.empty() || (count == out.size() && !before(item, out.back()))) return;
  const std::size_t last = count < out.size() ? count++ : count - 1;
  out[last] = item;
  for (std::size_t i = last; i > 0 && before(out[i], out[i - 1]); --i)
    std::swap(out[i], out[i - 1]);
}

}  // namespace lockstone
