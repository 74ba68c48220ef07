#include "net/session/parts_judge.h"

#include <algorithm>

namespace lockstone::net {

Parts parts_of(const Simulation& simulation) {
  std::array<PartHash, k_max_state_parts> hashed{};
  Parts parts;
  parts.ticks = simulation.tick();
  parts.count = static_cast<std::uint8_t>(simulation.part_hashes(hashed));
  for (std::size_t part = 0; part < parts.count; ++part)
    parts.hashes[part] = hashed[part].hash;
  return parts;
}

void PartsJudge::note_own(const Parts& parts) {
  entry_of(parts.ticks) = {parts, k_no_slot};
}

bool PartsJudge::compare(std::uint8_t slot, const Parts& parts, bool has_own) {
  Entry& entry = entry_of(parts.ticks);
  if (!has_own && entry.parts.ticks < parts.ticks) {
    entry = {parts, slot};
    return true;
  }
  if (entry.parts.ticks != parts.ticks) return false;  // not kept any more
  const Parts& right = entry.parts;
  const std::size_t count = std::min(right.count, parts.count);
  std::size_t part = 0;
  while (part < count && right.hashes[part] == parts.hashes[part])
    ++part;
  if (part == right.count && part == parts.count) return true;
  if (found_) return false;
  part = std::min(part, k_max_state_parts - 1);
  found_ =
      PartMismatch{parts.ticks, slot, entry.slot, part, right.hashes[part], parts.hashes[part]};
  return false;
}

}  // namespace lockstone::net
