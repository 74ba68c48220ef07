#include "net/session/server/comparison/state_comparison.h"

#include <array>

namespace lockstone::net {

void StateComparison::advance() {
  const bool judging = data_.match.is_played();
  while (judging && !cases_.freeze_match()) {
    const std::optional<Mismatch> found = data_.judge.advance();
    tell_agreed(found);
    if (!found) break;
    data_.parts_judge.forget(found->slot);
    response_.open(*found, {});
  }
  if (judging && !cases_.freeze_match()) compare_parts();
}

// In a relay: the hash that all players agree on.
void StateComparison::tell_agreed(const std::optional<Mismatch>& found) {
  if (data_.simulates()) return;
  const bool undecided = found && found->verdict == Verdict::undecided;
  const std::uint64_t end = undecided ? found->tick : data_.judge.judged_ticks();
  for (; agreed_told_ < end; ++agreed_told_)
    data_.observer->hash_agreed(agreed_told_, data_.judge.right().at(agreed_told_));
}

// Only differences that the hashes of every tick miss.
void StateComparison::compare_parts() {
  const std::uint64_t confirmed = data_.match.confirmed;
  SlotMask voters = 0;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    if (data_.roster.seat(slot).plays(confirmed)) voters |= slot_bit(slot);
  }
  PartsJudge& judge = data_.parts_judge;
  judge.vote(voters, confirmed);
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    if (cases_.freeze_match()) return;
    const std::optional<PartMismatch> found = judge.found(slot);
    if (!found || data_.judge.player(slot).judged < found->ticks) continue;
    judge.forget(slot);
    if (data_.roster.seat(slot).condemned) continue;
    data_.judge.ignore(slot);
    response_.open({found->ticks - 1, slot, found->reference, found->verdict, found->here.low,
                    found->there.low},
                   name_of_part(found->part));
  }
}

bool StateComparison::on_parts(const Peer& peer, ByteView packet) {
  Parts message;
  if (decode(packet, message) != Status::ok || message.ticks > data_.match.confirmed) return false;
  const bool counts = !data_.roster.seat(peer.slot).loading && !cases_.freeze_match();
  if (counts) data_.parts_judge.take(peer.slot, message);
  return true;
}

std::string StateComparison::name_of_part(std::size_t part) const {
  const Simulation* known = data_.describer();
  std::array<PartHash, k_max_state_parts> hashed{};
  const std::size_t count = known == nullptr ? 0 : known->part_hashes(hashed);
  return part < count ? std::string(hashed[part].name) : "part " + std::to_string(part);
}

}  // namespace lockstone::net
