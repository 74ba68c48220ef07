#include "tools/simnet/schedule.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "net/transport/random.h"

namespace lockstone::simnet {
namespace {

using net::Random;

constexpr std::array<std::string_view, k_fault_kinds> k_names{
    "loss",  "burst", "duplicate",   "reorder",     "delay", "jitter", "corrupt", "truncate",
    "forge", "cut",   "cut_sending", "cut_hearing", "pause", "kill",   "skew",    "disk_full"};

constexpr std::uint32_t k_longest_silence_ms = 4000;
constexpr std::uint32_t k_longest_death_ms = 12'000;  // longer than a server waits

// How likely a client suffers from a kind, in percent, and how much.
struct Draw {
  std::uint32_t chance;
  std::uint32_t least;
  std::uint32_t most;
};
constexpr std::array<Draw, k_fault_kinds> k_draws{{{60, 1'000, 300'000},
                                                   {40, 1'000, 30'000},
                                                   {40, 1'000, 200'000},
                                                   {40, 1'000, 200'000},
                                                   {70, 1, 500},
                                                   {50, 1, 100},
                                                   {20, 100, 20'000},
                                                   {20, 100, 20'000},
                                                   {15, 1, 20},
                                                   {25, 0, 0},
                                                   {20, 0, 0},
                                                   {20, 0, 0},
                                                   {25, 0, 0},
                                                   {25, 0, 0},
                                                   {50, 0, 1000},
                                                   {20, 0, 0}}};

std::uint32_t between(Random& random, std::uint32_t least, std::uint32_t most) {
  return least + static_cast<std::uint32_t>(random.below(most - least + 1));
}

// Small amounts are as likely as big ones: half of all draws lie below a tenth of the most.
std::uint32_t draw_amount(Random& random, const Draw& draw) {
  const bool small = random.chance(500'000);
  const std::uint32_t most = small ? std::max(draw.least, draw.most / 10) : draw.most;
  return between(random, draw.least, most);
}

FaultEvent draw_event(Random& random, FaultKind kind, std::uint8_t client, std::uint32_t heal_ms) {
  FaultEvent event{kind, client, 0, heal_ms, 0};
  event.amount = draw_amount(random, k_draws[static_cast<std::size_t>(kind)]);
  const std::uint32_t a = between(random, 0, heal_ms);
  const std::uint32_t b = between(random, 0, heal_ms);
  const bool whole = random.chance(300'000);
  if (!whole || silences(kind)) {
    event.from_ms = std::min(a, b);
    event.until_ms = std::max(a, b);
  }
  if (silences(kind)) {
    const std::uint32_t longest =
        kind == FaultKind::kill ? k_longest_death_ms : k_longest_silence_ms;
    event.until_ms = std::min(event.until_ms, event.from_ms + longest);
  }
  return event;
}

// Silences of one client that touch would together be longer than a server waits.
bool too_close(const Schedule& schedule, const FaultEvent& event) {
  return std::any_of(schedule.begin(), schedule.end(), [&event](const FaultEvent& other) {
    const bool same = other.client == event.client && silences(other.kind);
    return same && event.from_ms < other.until_ms + k_longest_silence_ms &&
           other.from_ms < event.until_ms + k_longest_silence_ms;
  });
}

bool take(std::string_view& text, std::string_view what) {
  if (text.substr(0, what.size()) != what) return false;
  text.remove_prefix(what.size());
  return true;
}

bool take(std::string_view& text, std::uint32_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, FaultKind& kind) {
  const std::string_view name = text.substr(0, text.find('@'));
  const auto found = std::find(k_names.begin(), k_names.end(), name);
  if (found == k_names.end()) return false;
  kind = static_cast<FaultKind>(found - k_names.begin());
  return take(text, name);
}

bool take(std::string_view& text, FaultEvent& event) {
  std::uint32_t client = 0;
  const bool read = take(text, event.kind) && take(text, "@") && take(text, client) &&
                    take(text, ":") && take(text, event.from_ms) && take(text, "-") &&
                    take(text, event.until_ms) && take(text, "=") && take(text, event.amount);
  event.client = static_cast<std::uint8_t>(client);
  return read && client < 16 && event.from_ms <= event.until_ms;
}

}  // namespace

bool silences(FaultKind kind) {
  return kind >= FaultKind::cut && kind <= FaultKind::kill;
}

std::string_view to_string(FaultKind kind) {
  return k_names[static_cast<std::size_t>(kind)];
}

std::optional<FaultMask> parse_faults(std::string_view text) {
  if (text == "all") return k_all_faults;
  if (text == "none") return 0;
  FaultMask mask = 0;
  while (!text.empty()) {
    const std::string_view name = text.substr(0, text.find(','));
    const auto found = std::find(k_names.begin(), k_names.end(), name);
    if (found == k_names.end()) return std::nullopt;
    mask |= 1U << (found - k_names.begin());
    text.remove_prefix(std::min(text.size(), name.size() + 1));
  }
  return mask;
}

std::string to_text(const Schedule& schedule) {
  if (schedule.empty()) return "none";
  std::string text;
  for (const FaultEvent& event : schedule) {
    if (!text.empty()) text += ',';
    text += std::string(to_string(event.kind)) + '@' + std::to_string(event.client) + ':' +
            std::to_string(event.from_ms) + '-' + std::to_string(event.until_ms) + '=' +
            std::to_string(event.amount);
  }
  return text;
}

std::optional<Schedule> parse_schedule(std::string_view text) {
  Schedule schedule;
  if (text == "none") return schedule;
  do {
    FaultEvent event;
    if (!take(text, event)) return std::nullopt;
    schedule.push_back(event);
  } while (take(text, ","));
  if (!text.empty()) return std::nullopt;
  return schedule;
}

Schedule draw_schedule(std::uint64_t seed, FaultMask kinds, std::size_t clients,
                       std::uint32_t heal_ms) {
  Schedule schedule;
  for (std::size_t kind = 0; kind < k_fault_kinds; ++kind) {
    Random random(seed ^ (std::uint64_t{kind + 1} << 48));
    for (std::size_t client = 0; client < clients; ++client) {
      const bool hit = random.below(100) < k_draws[kind].chance;
      const FaultEvent event = draw_event(random, static_cast<FaultKind>(kind),
                                          static_cast<std::uint8_t>(client), heal_ms);
      const bool once = event.kind != FaultKind::disk_full || client == 0;
      const bool wanted = hit && once && ((kinds >> kind) & 1) != 0;
      if (wanted && !(silences(event.kind) && too_close(schedule, event))) {
        schedule.push_back(event);
      }
    }
  }
  return schedule;
}

}  // namespace lockstone::simnet
