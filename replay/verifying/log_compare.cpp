#include <algorithm>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/tick_reader.h>

#include "replay/verifying/verification.h"

namespace lockstone::replay {
namespace {

std::optional<InputDifference> compare_inputs(std::uint64_t tick, std::span<const PlayerInput> here,
                                              std::span<const PlayerInput> there) {
  for (std::size_t slot = 0; slot < std::min(here.size(), there.size()); ++slot) {
    const PlayerInput &a = here[slot], &b = there[slot];
    const auto [in_a, in_b] =
        std::mismatch(a.bytes.begin(), a.bytes.end(), b.bytes.begin(), b.bytes.end());
    InputDifference difference{.tick = tick, .slot = static_cast<std::uint8_t>(slot)};
    if (in_a != a.bytes.end() && in_b != b.bytes.end()) {
      difference.byte = static_cast<std::size_t>(in_a - a.bytes.begin());
      difference.here = std::to_integer<std::uint8_t>(*in_a);
      difference.there = std::to_integer<std::uint8_t>(*in_b);
      return difference;
    }
    if (a.origin == b.origin) continue;
    difference.in_origin = true;
    difference.here = static_cast<std::uint8_t>(a.origin);
    difference.there = static_cast<std::uint8_t>(b.origin);
    return difference;
  }
  return std::nullopt;
}

std::optional<CommandDifference> compare_commands(std::uint64_t tick,
                                                  std::span<const PlayerCommand> here,
                                                  std::span<const PlayerCommand> there) {
  const auto [a, b] = std::mismatch(here.begin(), here.end(), there.begin(), there.end(),
                                    [](const PlayerCommand& one, const PlayerCommand& other) {
                                      return one.slot == other.slot &&
                                             std::equal(one.bytes.begin(), one.bytes.end(),
                                                        other.bytes.begin(), other.bytes.end());
                                    });
  if (a == here.end() && b == there.end()) return std::nullopt;
  CommandDifference difference{tick, static_cast<std::size_t>(a - here.begin())};
  if (a != here.end()) difference.here = {a->slot, a->bytes.size()};
  if (b != there.end()) difference.there = {b->slot, b->bytes.size()};
  if (difference.here && difference.there) {
    const auto at =
        std::mismatch(a->bytes.begin(), a->bytes.end(), b->bytes.begin(), b->bytes.end()).first;
    difference.byte = static_cast<std::size_t>(at - a->bytes.begin());
  }
  return difference;
}

void compare_ticks(const TickReader& here, const TickReader& there, LogComparison& result) {
  if (result.ticks++ == 0) result.first_tick = here.tick();
  if (!result.input) result.input = compare_inputs(here.tick(), here.inputs(), there.inputs());
  if (!result.command)
    result.command = compare_commands(here.tick(), here.commands(), there.commands());
  if (!result.hash && here.hash() != there.hash()) {
    result.hash = HashDifference{here.tick(), here.hash(), there.hash()};
  }
}

bool open(TickReader& ticks, LogComparison& result) {
  result.status = ticks.open();
  if (result.status != Status::ok) result.what = ticks.reader().damage().what;
  return result.status == Status::ok;
}

void note_damage(const TickReader& ticks, LogComparison& result) {
  const Damage& damage = ticks.reader().damage();
  if (result.status != Status::ok || damage.status == Status::ok) return;
  result.status = damage.status;
  result.what = damage.what;
}

}  // namespace

bool LogComparison::same() const {
  return status == Status::ok && header.empty() && same_config && !input && !command && !hash &&
         end_here == end_there;
}

std::optional<std::uint64_t> LogComparison::first_difference() const {
  std::optional<std::uint64_t> first;
  const auto note = [&first](const auto& difference) {
    if (difference) first = std::min(first.value_or(difference->tick), difference->tick);
  };
  note(input);
  note(command);
  note(hash);
  return first;
}

LogComparison compare_logs(Source& here, Source& there) {
  LogComparison result;
  TickReader a(here), b(there);
  if (!open(a, result) || !open(b, result)) return result;
  result.header = compare_info(a.reader().header().info, b.reader().header().info);
  result.same_config =
      std::equal(a.config().begin(), a.config().end(), b.config().begin(), b.config().end());
  result.end_here = a.reader().header().match.start_tick;
  result.end_there = b.reader().header().match.start_tick;
  bool more_a = a.next(), more_b = b.next();
  while (more_a || more_b) {
    const bool take_a = more_a && (!more_b || a.tick() <= b.tick());
    const bool take_b = more_b && (!more_a || b.tick() <= a.tick());
    if (take_a && take_b) compare_ticks(a, b, result);
    if (take_a) result.end_here = a.tick() + 1;
    if (take_b) result.end_there = b.tick() + 1;
    if (take_a) more_a = a.next();
    if (take_b) more_b = b.next();
  }
  note_damage(a, result);
  note_damage(b, result);
  return result;
}

}  // namespace lockstone::replay
