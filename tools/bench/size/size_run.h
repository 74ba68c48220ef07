// Worlds of one kind in many sizes: time and memory against the number of bodies.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/world.h>

#include "tools/bench/support/measure.h"

namespace lockstone::bench {

struct SizeKind {
  std::string_view name;
  std::string_view text;
  std::uint32_t ticks = 0;        ///< that are timed
  std::uint32_t most_bodies = 0;  ///< of the largest world
  World (*make)(std::uint32_t bodies) = nullptr;

  /// Commands before a step, timed with it; may be null.
  void (*drive)(World& world) = nullptr;
};

[[nodiscard]] std::span<const SizeKind> size_kinds();

/// Null for an unknown name.
[[nodiscard]] const SizeKind* find_size_kind(std::string_view name);

struct SizeFigures {
  std::string_view kind;
  std::uint32_t bodies = 0;    ///< dynamic ones
  std::uint32_t ticks = 0;     ///< that were timed
  double make_ns = 0;          ///< to make the world and let it come to rest, where its kind does
  double tick_ns = 0;          ///< the mean
  double tick_p99_ns = 0;      ///< 99th percentile
  double moving = 0;           ///< bodies awake, mean over the ticks
  double contacts = 0;         ///< between awake bodies, mean over the ticks
  std::uint64_t heap = 0;      ///< bytes that the world takes; 0 where that is not known
  std::uint64_t snapshot = 0;  ///< bytes of a native one
  double save_ns = 0;          ///< a native snapshot
  double load_ns = 0;          ///< the same
  double hash_ns = 0;          ///< after the last tick
  double destroy_ns = 0;       ///< a body by a command, mean over the last thousand
  double highest = 0;          ///< m, the highest centre of a dynamic body at the end
  std::uint64_t hash = 0;      ///< of the last state
  bool had_room = true;        ///< for all pairs and contacts, in every step
};

[[nodiscard]] SizeFigures measure_size(const SizeKind& kind, std::uint32_t bodies, Clock clock);

}  // namespace lockstone::bench
