#include "tools/lockstone/logs/state/hash_compare.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <lockstone/replay/snapshot_file.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

constexpr const char* k_ends = "ends";

using Chain = std::map<std::uint64_t, std::string>;

std::string hash_at(const LogHashes& file, std::uint64_t tick) {
  const auto found = file.hashes.find(tick);
  return found == file.hashes.end() ? k_ends : found->second;
}

// The lowest tick at which the chains are not equal.
std::optional<std::uint64_t> parting(const Chain& here, const Chain& there) {
  auto a = here.begin(), b = there.begin();
  for (; a != here.end() && b != there.end(); ++a, ++b)
    if (*a != *b) return std::min(a->first, b->first);
  if (a != here.end()) return a->first;
  if (b != there.end()) return b->first;
  return std::nullopt;
}

void group_at(const std::vector<LogHashes>& files, std::uint64_t tick, HashComparison& result) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string hash = hash_at(files[i], tick);
    const auto same = [&](const HashGroup& group) { return group.hash == hash; };
    const auto found = std::ranges::find_if(result.groups, same);
    if (found != result.groups.end()) {
      found->files.push_back(i);
    } else {
      result.groups.push_back({{i}, hash});
    }
  }
  std::stable_sort(
      result.groups.begin(), result.groups.end(),
      [](const HashGroup& a, const HashGroup& b) { return a.files.size() > b.files.size(); });
}

void add_note(HashComparison& result, const std::string& why) {
  if (result.note.find(why) != std::string::npos) return;
  result.note += (result.note.empty() ? "" : "; ") + why;
}

// Why a state that both kept names nothing: the difference healed before, or the game does not show
// it.
std::string note_of_equal(const LogHashes& here, const LogHashes& there, std::uint64_t tick) {
  if (hash_at(here, tick) != hash_at(there, tick))
    return fmt::format("the game shows no difference between the states at tick {}", tick);
  return fmt::format("the states are equal again at tick {}: hash again with --parts-every 1",
                     tick);
}

std::optional<std::string> first_different_part(const LogHashes::Parts& here,
                                                const LogHashes::Parts& there) {
  for (const auto& [name, hash] : here) {
    const auto found = there.find(name);
    if (found == there.end() || found->second != hash) return name;
  }
  return std::nullopt;
}

// The first part that differs, in the first state at or after the tick whose parts both have.
void find_part(const LogHashes& here, const LogHashes& there, std::uint64_t after,
               HashComparison& result) {
  std::string note = "no hashes of parts after this tick in both";
  bool is_first = true;
  for (auto at = here.parts.lower_bound(after); at != here.parts.end(); ++at) {
    const auto other = there.parts.find(at->first);
    if (other == there.parts.end()) continue;
    const auto part = first_different_part(at->second, other->second);
    if (part) {
      result.part = *part;
      result.part_tick = at->first;
      return;
    }
    if (is_first) note = note_of_equal(here, there, at->first);
    is_first = false;
  }
  add_note(result, note);
}

std::optional<std::vector<std::byte>> bytes_of(const std::string& digits) {
  std::vector<std::byte> bytes;
  const auto value = [](char digit) {
    return digit >= '0' && digit <= '9'   ? digit - '0'
           : digit >= 'a' && digit <= 'f' ? digit - 'a' + 10
                                          : -1;
  };
  if (digits.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const int high = value(digits[i]), low = value(digits[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes.push_back(static_cast<std::byte>(high * 16 + low));
  }
  return bytes;
}

std::optional<std::vector<std::byte>> read_state(const std::string& folder, std::uint64_t tick) {
  const std::optional<std::string> text = read_file(state_file(folder, tick));
  if (!text) return std::nullopt;
  auto unpacked = replay::unpack_snapshot(std::as_bytes(std::span(*text)));
  if (!unpacked.ok()) return std::nullopt;
  return std::move(unpacked).value();
}

// The game that describes states, made from the configuration in the file; else null, with a note.
std::unique_ptr<Simulation> make_describer(const LogHashes& file, const Games& games,
                                           HashComparison& result) {
  const auto refused = [&](const std::string& why) {
    add_note(result, why);
    return nullptr;
  };
  const GameDef* game = games.find(file.game);
  if (game == nullptr) return refused("the game '" + file.game + "' is not known here: use --game");
  if (!file.config) return refused(file.path + " holds no configuration: it is too long");
  const auto config = bytes_of(*file.config);
  if (!config) return refused("the configuration in " + file.path + " is damaged");
  auto simulation = game->make(*config);
  if (!simulation) return refused("the game refuses the configuration in " + file.path);
  return std::move(simulation).value();
}

// The first field that differs, in the first state at or after the tick that both kept.
void find_field(const LogHashes& here, const LogHashes& there, std::uint64_t after,
                const Games& games, HashComparison& result) {
  if (here.states.empty() || there.states.empty())
    return add_note(result, "states were not kept: `hash --states` lets this name the field");
  const std::unique_ptr<Simulation> simulation = make_describer(here, games, result);
  if (simulation == nullptr) return;
  std::string note = "no state after this tick was kept by both";
  bool is_first = true;
  for (auto at = here.hashes.lower_bound(after); at != here.hashes.end(); ++at) {
    const auto ours = read_state(here.states, at->first);
    const auto theirs = ours ? read_state(there.states, at->first) : std::nullopt;
    if (!theirs) continue;
    const StateDifference difference = simulation->describe(*ours, *theirs);
    if (difference.differs) {
      result.field = difference;
      result.field_tick = at->first;
      return;
    }
    if (is_first) note = note_of_equal(here, there, at->first);
    is_first = false;
  }
  add_note(result, note);
}

// "body 17, velocity.y: 0x… in A, 0x… in B".
std::string in_groups(const StateDifference& difference) {
  constexpr std::string_view k_here = " here, ", k_there = " there";
  std::string line = difference.to_line();
  if (line.ends_with(k_there)) line.replace(line.size() - k_there.size(), k_there.size(), " in B");
  const std::size_t here = line.rfind(k_here);
  if (here != std::string::npos) line.replace(here, k_here.size(), " in A, ");
  return line;
}

}  // namespace

std::string HashComparison::to_line() const {
  if (same()) return fmt::format("all equal, {} ticks", ticks);
  std::string line = fmt::format("tick {}", first_tick);
  if (!part.empty()) line += fmt::format(", part {} (state at {})", part, part_tick);
  if (field) line += fmt::format(", {} (state at {})", in_groups(*field), field_tick);
  return line;
}

HashComparison compare_log_hashes(const std::vector<LogHashes>& files, const Games& games) {
  HashComparison result;
  std::optional<std::uint64_t> first;
  for (const LogHashes& file : files) {
    const auto tick = parting(files.front().hashes, file.hashes);
    if (tick) first = first ? std::min(*first, *tick) : *tick;
  }
  const Chain& chain = files.front().hashes;
  const std::uint64_t after = first.value_or(chain.rbegin()->first);
  group_at(files, after, result);
  const auto end = first ? chain.lower_bound(after) : chain.end();
  result.ticks = static_cast<std::uint64_t>(std::distance(chain.begin(), end));
  if (!first) return result;
  result.first_tick = after == 0 ? 0 : after - 1;
  const LogHashes& here = files[result.groups[0].files.front()];
  const LogHashes& there = files[result.groups[1].files.front()];
  find_part(here, there, after, result);
  find_field(here, there, after, games, result);
  return result;
}

}  // namespace lockstone::tool
