#include "tools/bench/accuracy/accuracy.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

namespace lockstone::bench {
namespace {

constexpr std::array<AccuracyRow, 3> k_rows{{
    {23, "fast bodies against thin walls", 100'000, measure_tunnels},
    {24, "rays, shape casts, distances", 1'000'000, measure_queries},
    {25, "mass of hulls and compounds", 20'000, measure_masses},
}};

}  // namespace

std::span<const AccuracyRow> accuracy_rows() {
  return k_rows;
}

void for_blocks(std::uint64_t tries, std::uint64_t block, int threads,
                const std::function<void(std::uint64_t first, std::uint64_t count)>& work) {
  std::atomic<std::uint64_t> next{0};
  const auto run = [&] {
    for (std::uint64_t first = next.fetch_add(block); first < tries; first = next.fetch_add(block))
      work(first, std::min(block, tries - first));
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i)
    others.emplace_back(run);
  run();
  for (std::thread& thread : others)
    thread.join();
}

}  // namespace lockstone::bench
