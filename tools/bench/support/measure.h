// The benchmarks' clock, and quantiles of its readings.
#pragma once

#include <cstdint>
#include <vector>

namespace lockstone::bench {

/// Nanoseconds of the steady clock.
[[nodiscard]] std::uint64_t now_nanoseconds();

/// Nanoseconds that this thread itself ran, without the time of other threads on its processor. A
/// call costs several times one of the steady clock.
[[nodiscard]] std::uint64_t thread_nanoseconds();

using Clock = std::uint64_t (*)();

/// Bytes that are allocated from the heap; 0 where that is not known (C libraries but glibc,
/// sanitizers).
[[nodiscard]] std::uint64_t heap_bytes();

/// How much of its own time an interval between two calls of a clock holds, in nanoseconds: the
/// median of many empty ones.
[[nodiscard]] double clock_overhead(Clock clock);

/// The value below which a share (0 … 1) of the values lie; one of them. 0 for none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

[[nodiscard]] inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace lockstone::bench
