#include "net/session/parts_judge.h"

#include <algorithm>
#include <bit>

namespace lockstone::net {
namespace {

constexpr std::size_t k_checks = 8;
constexpr std::uint64_t k_patience_ticks = 4 * k_parts_interval_ticks;

std::size_t place_of(std::uint64_t ticks, std::size_t count) {
  return static_cast<std::size_t>(ticks / k_parts_interval_ticks % count);
}

std::size_t first_difference(const Parts& a, const Parts& b) {
  const std::size_t both = std::min(a.count, b.count);
  std::size_t part = 0;
  while (part < both && a.hashes[part] == b.hashes[part])
    ++part;
  return part;
}

bool same(const Parts& a, const Parts& b) {
  return a.count == b.count && first_difference(a, b) == a.count;
}

}  // namespace

Parts parts_of(const Simulation& simulation) {
  std::array<PartHash, k_max_state_parts> hashed{};
  Parts parts;
  parts.ticks = simulation.tick();
  parts.count = static_cast<std::uint8_t>(simulation.part_hashes(hashed));
  for (std::size_t part = 0; part < parts.count; ++part)
    parts.hashes[part] = hashed[part].hash;
  return parts;
}

PartsJudge::PartsJudge(bool has_own) : has_own_(has_own), checks_(has_own ? 0 : k_checks) {}

void PartsJudge::note_own(const Parts& parts) {
  own_[place_of(parts.ticks, own_.size())] = parts;
}

void PartsJudge::take(std::uint8_t slot, const Parts& parts) {
  if (has_own_) {
    const Parts& right = own_[place_of(parts.ticks, own_.size())];
    if (right.ticks != parts.ticks) return;  // not kept any more
    return compare(slot, parts, k_no_slot, right, Verdict::client_diverged);
  }
  Check& check = checks_[place_of(parts.ticks, k_checks)];
  if (parts.ticks < check.ticks) return;
  if (parts.ticks > check.ticks) {
    check.ticks = parts.ticks;
    check.reported = 0;
    check.decided = false;
  }
  if (check.decided || has_slot(check.reported, slot)) return;
  check.parts[slot] = parts;
  check.reported |= slot_bit(slot);
}

void PartsJudge::compare(std::uint8_t slot, const Parts& theirs, std::uint8_t reference,
                         const Parts& right, Verdict verdict) {
  if (same(theirs, right)) {
    ++equal_[slot];
    return;
  }
  if (found_[slot]) return;
  const std::size_t part = std::min(first_difference(theirs, right), k_max_state_parts - 1);
  found_[slot] = PartMismatch{
      theirs.ticks, slot, reference, verdict, part, right.hashes[part], theirs.hashes[part]};
}

void PartsJudge::vote(SlotMask voters, std::uint64_t confirmed) {
  for (Check& check : checks_) {
    if (check.ticks == 0 || check.decided) continue;
    const bool all = (check.reported & voters) == voters;
    if (all || confirmed >= check.ticks + k_patience_ticks) decide(check, voters);
  }
}

unsigned PartsJudge::votes_for(const Check& check, SlotMask members, std::uint8_t slot) {
  unsigned votes = 0;
  for (std::size_t other = 0; other < k_max_players; ++other) {
    const bool agrees = has_slot(members, other) && same(check.parts[other], check.parts[slot]);
    votes += agrees ? 1 : 0;
  }
  return votes;
}

// Ties go to the lowest slot, as a reference alone: without a majority nothing is decided.
void PartsJudge::decide(Check& check, SlotMask voters) {
  check.decided = true;
  const SlotMask members = check.reported & voters;
  std::uint8_t speaker = k_no_slot;
  unsigned most = 0;
  for (std::uint8_t slot = 0; slot < k_max_players; ++slot) {
    const unsigned votes = has_slot(members, slot) ? votes_for(check, members, slot) : 0;
    if (votes <= most) continue;
    most = votes;
    speaker = slot;
  }
  const auto all = static_cast<unsigned>(std::popcount(members));
  const Verdict verdict = 2 * most > all ? Verdict::minority : Verdict::undecided;
  for (std::uint8_t slot = 0; slot < k_max_players; ++slot) {
    if (!has_slot(members, slot)) continue;
    compare(slot, check.parts[slot], speaker, check.parts[speaker], verdict);
  }
}

}  // namespace lockstone::net
