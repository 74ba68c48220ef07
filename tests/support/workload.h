// How much of a long test runs: all of it, or with sanitizers, which take ten times as long, a part.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LKS_TEST_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LKS_TEST_SANITIZED
#endif
#endif

namespace lockstone::test {

#if defined(LKS_TEST_SANITIZED)
inline constexpr int k_share = 8;
#else
inline constexpr int k_share = 1;
#endif

/// Of cases or ticks that are alike: all of them, an eighth with sanitizers, and at least one.
template <class Count>
[[nodiscard]] constexpr Count share_of(Count all) {
  return (all + k_share - 1) / k_share;
}

}  // namespace lockstone::test
