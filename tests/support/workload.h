// How much of a long test runs: all of it, or with sanitizers, ten times as slow, a part.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/sanitized.h"

namespace lockstone::test {

inline constexpr int k_share = LKS_SANITIZED ? 8 : 1;

/// Of cases or ticks that are alike: all of them, an eighth with sanitizers, and at least one.
template <class Count>
[[nodiscard]] constexpr Count share_of(Count all) {
  return (all + k_share - 1) / k_share;
}

/// The first of every eight alike cases with sanitizers, otherwise all of them.
template <class Case>
[[nodiscard]] std::vector<Case> share_of_cases(const std::vector<Case>& all) {
  std::vector<Case> result;
  for (std::size_t at = 0; at < all.size(); at += k_share)
    result.push_back(all[at]);
  return result;
}

}  // namespace lockstone::test
