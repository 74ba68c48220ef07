// How much of a long test runs: all of it, or with sanitizers, which take ten times as long, a part.
#pragma once

#include "core/base/sanitized.h"

namespace lockstone::test {

inline constexpr int k_share = LKS_SANITIZED ? 8 : 1;

/// Of cases or ticks that are alike: all of them, an eighth with sanitizers, and at least one.
template <class Count>
[[nodiscard]] constexpr Count share_of(Count all) {
  return (all + k_share - 1) / k_share;
}

}  // namespace lockstone::test
