// Waiting for events that other threads, processes and sockets cause in their own time.
#pragma once

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace lockstone::test {

/// Returns as soon as `done()` is true. A minute is longer than any machine takes: then it fails.
template <class Done>
void await(const Done& done) {
  using Clock = std::chrono::steady_clock;
  for (const auto end = Clock::now() + std::chrono::minutes(1); !done();) {
    if (Clock::now() > end) {
      ADD_FAILURE() << "waited for nothing";
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace lockstone::test
