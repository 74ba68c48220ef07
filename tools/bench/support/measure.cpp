#include "tools/bench/support/measure.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__EMSCRIPTEN__)
#include <emscripten.h>

// Emscripten knows no processor time; Node does, of the whole process, as tools/bench/peers/node
// asks it too.
EM_JS(double, process_microseconds, (), {
  const used = process.cpuUsage();
  return used.user + used.system;
})
#endif

namespace lockstone::bench {

std::uint64_t now_nanoseconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::uint64_t thread_nanoseconds() {
#if defined(__EMSCRIPTEN__)
  return static_cast<std::uint64_t>(process_microseconds() * 1000);
#else
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U +
         static_cast<std::uint64_t>(time.tv_nsec);
#endif
}

std::uint64_t heap_bytes() {
#if defined(__GLIBC__)
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
#else
  return 0;
#endif
}

double clock_overhead(Clock clock) {
  constexpr int k_intervals = 1000;
  std::vector<double> times;
  for (int i = 0; i < k_intervals; ++i) {
    const std::uint64_t begin = clock();
    times.push_back(static_cast<double>(clock() - begin));
  }
  return median(std::move(times));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace lockstone::bench
