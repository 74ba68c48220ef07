// Work on many independent things, handed out in blocks to several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace lockstone::tool {

/// Calls `work(first, count)` once for each block of `block` indices below `total`, on `threads`
/// threads, the caller's among them. Which thread gets which block is left to chance.
template <class Work>
void for_blocks(std::uint64_t total, std::uint64_t block, int threads, const Work& work) {
  std::atomic<std::uint64_t> next{0};
  const auto run = [&] {
    for (std::uint64_t first = next.fetch_add(block); first < total; first = next.fetch_add(block))
      work(first, std::min(block, total - first));
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i)
    others.emplace_back(run);
  run();
  for (std::thread& thread : others)
    thread.join();
}

}  // namespace lockstone::tool
