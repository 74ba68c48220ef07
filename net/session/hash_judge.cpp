#include "net/session/hash_judge.h"

#include <algorithm>

namespace lockstone::net {

HashJudge::HashJudge(std::size_t player_count, std::size_t history_ticks, bool has_own)
    : has_own_(has_own), history_ticks_(history_ticks), own_(history_ticks) {
  players_.resize(player_count);
  pending_.reserve(player_count);
  for (Player& player : players_)
    player.reported = HashRing(history_ticks);
}

bool HashJudge::can_push(std::size_t slot) const {
  const Player& player = players_[slot];
  return player.ignored || wanted(slot) - player.judged < history_ticks_;
}

void HashJudge::restart(std::size_t slot, std::uint64_t tick) {
  Player& player = players_[slot];
  player.reported.restart(tick);
  player.first = tick;
  player.judged = tick;
  player.present = false;
  player.ignored = false;
}

std::optional<Mismatch> HashJudge::advance() {
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    if (const std::optional<Mismatch> found = compare_with_own(slot)) return found;
  }
  return has_own_ ? std::nullopt : compare_players();
}

std::optional<Mismatch> HashJudge::compare_with_own(std::uint8_t slot) {
  Player& player = players_[slot];
  const std::uint64_t end = std::min(player.reported.next_tick(), own_.next_tick());
  while (player.judged < end && !player.ignored) {
    const std::uint64_t tick = player.judged++;
    ++player.compared;
    if (player.reported.at(tick) != own_.at(tick)) {
      player.ignored = true;
      const Verdict verdict = has_own_ ? Verdict::client_diverged : Verdict::minority;
      const std::uint8_t speaker = has_own_ ? k_no_slot : speaker_for(tick);
      return Mismatch{tick, slot, speaker, verdict, own_.at(tick), player.reported.at(tick)};
    }
    ++player.equal;
  }
  return std::nullopt;
}

bool HashJudge::takes_part(const Player& player, std::uint64_t tick) const {
  return !player.ignored && player.first <= tick && player.reported.next_tick() > tick;
}

// A player that had the agreed hash of a tick: the first one that still takes part.
std::uint8_t HashJudge::speaker_for(std::uint64_t tick) const {
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    if (takes_part(players_[slot], tick) && players_[slot].judged > tick) return slot;
  }
  return k_no_slot;
}

bool HashJudge::all_reported(std::uint64_t tick) const {
  bool any = false;
  for (const Player& player : players_) {
    if (player.present && !player.ignored && !takes_part(player, tick)) return false;
    any = any || takes_part(player, tick);
  }
  return any;
}

// The lowest slot whose hash of the tick in question most players share; ties go to the lowest.
std::uint8_t HashJudge::speaker_of_largest_group(std::size_t& votes, std::size_t& all) const {
  std::uint8_t speaker = k_no_slot;
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    if (!takes_part(players_[slot], shared_judged_)) continue;
    ++all;
    const std::uint64_t hash = players_[slot].reported.at(shared_judged_);
    const auto group =
        std::count_if(players_.begin(), players_.end(), [this, hash](const Player& other) {
          return takes_part(other, shared_judged_) && other.reported.at(shared_judged_) == hash;
        });
    if (static_cast<std::size_t>(group) <= votes) continue;
    votes = static_cast<std::size_t>(group);
    speaker = slot;
  }
  return speaker;
}

std::optional<Mismatch> HashJudge::compare_players() {
  while (pending_.empty() && all_reported(shared_judged_)) {
    compare_tick(shared_judged_);
    ++shared_judged_;
  }
  if (pending_.empty()) return std::nullopt;
  const Mismatch found = pending_.front();
  pending_.erase(pending_.begin());
  return found;
}

void HashJudge::compare_tick(std::uint64_t tick) {
  std::size_t votes = 0;
  std::size_t all = 0;
  const std::uint8_t speaker = speaker_of_largest_group(votes, all);
  const std::uint64_t right = players_[speaker].reported.at(tick);
  const Verdict verdict = 2 * votes > all ? Verdict::minority : Verdict::undecided;
  own_.push(right);
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    Player& player = players_[slot];
    if (!takes_part(player, tick)) continue;
    ++player.compared;
    player.judged = tick + 1;
    const std::uint64_t hash = player.reported.at(tick);
    if (hash == right) {
      ++player.equal;
    } else {
      pending_.push_back({tick, slot, speaker, verdict, right, hash});
      player.ignored = true;
    }
  }
}

std::uint64_t HashJudge::judged_ticks() const {
  if (!has_own_) return shared_judged_;
  std::uint64_t judged = own_.next_tick();
  for (const Player& player : players_) {
    if (player.present && !player.ignored) judged = std::min(judged, player.judged);
  }
  return judged;
}

}  // namespace lockstone::net
