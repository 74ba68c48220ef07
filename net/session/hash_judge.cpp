#include "net/session/hash_judge.h"

#include <algorithm>
#include <span>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

/// The players who share the most frequent hash of a tick.
struct Group {
  std::uint8_t speaker = k_no_slot;  ///< the lowest slot among them; ties go to the lowest
  std::size_t votes = 0;
  std::size_t all = 0;  ///< votes of all groups
};

Group largest_group(std::span<const PlayerHashes> players, std::uint64_t tick) {
  Group largest;
  for (std::uint8_t slot = 0; slot < players.size(); ++slot) {
    if (!players[slot].counts_at(tick)) continue;
    ++largest.all;
    const std::uint64_t hash = players[slot].reported.at(tick);
    const auto votes =
        std::count_if(players.begin(), players.end(), [tick, hash](const PlayerHashes& other) {
          return other.counts_at(tick) && other.reported.at(tick) == hash;
        });
    if (static_cast<std::size_t>(votes) <= largest.votes) continue;
    largest.votes = static_cast<std::size_t>(votes);
    largest.speaker = slot;
  }
  return largest;
}

// A player that had the right hash of a tick: the first one that still takes part.
std::uint8_t speaker_for(std::span<const PlayerHashes> players, std::uint64_t tick) {
  for (std::uint8_t slot = 0; slot < players.size(); ++slot) {
    if (players[slot].counts_at(tick) && players[slot].judged > tick) return slot;
  }
  return k_no_slot;
}

bool all_reported(std::span<const PlayerHashes> players, std::uint64_t tick) {
  bool any = false;
  for (const PlayerHashes& player : players) {
    const bool counts = player.counts_at(tick);
    if (player.present && !player.ignored && !counts) return false;
    any = any || counts;
  }
  return any;
}

}  // namespace

HashJudge::HashJudge(std::size_t player_count, std::size_t history_ticks, bool has_own)
    : has_own_(has_own), history_ticks_(history_ticks), right_(history_ticks) {
  players_.resize(player_count);
  pending_.reserve(player_count);
  for (PlayerHashes& player : players_)
    player.reported = HashRing(history_ticks);
}

bool HashJudge::can_push(std::size_t slot) const {
  const PlayerHashes& player = players_[slot];
  return player.ignored || wanted(slot) - player.judged < history_ticks_;
}

void HashJudge::push(std::size_t slot, std::uint64_t hash) {
  LKS_ASSERT(can_push(slot));
  players_[slot].reported.push(hash);
}

void HashJudge::restart(std::size_t slot, std::uint64_t tick) {
  PlayerHashes& player = players_[slot];
  player.reported.restart(tick);
  player.first = tick;
  player.judged = tick;
  player.present = false;
  player.ignored = false;
}

std::optional<Mismatch> HashJudge::advance() {
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    if (const std::optional<Mismatch> found = compare_with_right(slot)) return found;
  }
  return has_own_ ? std::nullopt : compare_players();
}

std::optional<Mismatch> HashJudge::compare_with_right(std::uint8_t slot) {
  PlayerHashes& player = players_[slot];
  const std::uint64_t end = std::min(player.reported.next_tick(), right_.end());
  while (player.judged < end && !player.ignored) {
    const std::uint64_t tick = player.judged++;
    ++player.compared;
    if (player.reported.at(tick) != right_.at(tick)) {
      player.ignored = true;
      const Verdict verdict = has_own_ ? Verdict::client_diverged : Verdict::minority;
      const std::uint8_t speaker = has_own_ ? k_no_slot : speaker_for(players_, tick);
      return Mismatch{tick, slot, speaker, verdict, right_.at(tick), player.reported.at(tick)};
    }
    ++player.equal;
  }
  return std::nullopt;
}

std::optional<Mismatch> HashJudge::compare_players() {
  while (pending_.empty() && all_reported(players_, shared_judged_)) {
    compare_tick(shared_judged_);
    ++shared_judged_;
  }
  if (pending_.empty()) return std::nullopt;
  const Mismatch found = pending_.front();
  pending_.erase(pending_.begin());
  return found;
}

void HashJudge::compare_tick(std::uint64_t tick) {
  const Group group = largest_group(players_, tick);
  LKS_ASSERT(group.speaker != k_no_slot && right_.end() == tick);
  const std::uint64_t right = players_[group.speaker].reported.at(tick);
  const bool decided = 2 * group.votes > group.all;
  const Verdict verdict = decided ? Verdict::minority : Verdict::undecided;
  right_.push(right);
  for (std::uint8_t slot = 0; slot < players_.size(); ++slot) {
    PlayerHashes& player = players_[slot];
    if (!player.counts_at(tick)) continue;
    ++player.compared;
    player.judged = tick + 1;
    const std::uint64_t hash = player.reported.at(tick);
    if (hash == right) {
      ++player.equal;
    } else {
      pending_.push_back({tick, slot, group.speaker, verdict, right, hash});
      player.ignored = true;
    }
  }
}

std::uint64_t HashJudge::judged_ticks() const {
  if (!has_own_) return shared_judged_;
  std::uint64_t judged = right_.end();
  for (const PlayerHashes& player : players_) {
    if (player.present && !player.ignored) judged = std::min(judged, player.judged);
  }
  return judged;
}

}  // namespace lockstone::net
