// Waiting for another thread that is about to be done.
#pragma once

#include <thread>

namespace lockstone {

/// Tells the processor that this thread only waits, for ten to fifty nanoseconds.
inline void relax_processor() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("isb" ::: "memory");
#endif
}

/// Each call waits a moment; after many of them, some 20 to 100 µs, the thread makes way for
/// others: the wait takes longer only when another thread was descheduled, and a thread that yields
/// too early may get the processor back much later.
class Pause {
 public:
  void operator()() {
    if (++count_ < k_before_yield) return relax_processor();
    std::this_thread::yield();
  }

 private:
  static constexpr int k_before_yield = 2000;
  int count_ = 0;
};

}  // namespace lockstone
