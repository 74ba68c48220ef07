#include "net/session/server/leaving/match_end.h"

#include <algorithm>
#include <optional>

namespace lockstone::net {

void MatchEnd::begin_finishing() {
  const bool began = data_.match.state == ServerState::running;
  data_.match.enter(ServerState::finishing);
  data_.match.waiting = 0;
  if (!began) finish(data_.match.finish_reason);
}

void MatchEnd::try_finish() {
  const MatchStatus& match = data_.match;
  const bool all_judged = data_.judge.judged_ticks() >= match.confirmed;
  const bool timed_out = match.now_us - match.state_since_us > data_.config.timeouts.finish_us;
  const bool complete = cases_.empty() && all_judged;
  if (cases_.freeze_match() || (!complete && !timed_out)) return;
  finish(match.finish_reason);
}

void MatchEnd::finish_if_deserted() {
  const MatchStatus& match = data_.match;
  if (!match.is_played() || !cases_.empty() || data_.roster.present_mask() != 0) return;
  const bool running = match.state == ServerState::running;
  const auto& seats = data_.roster.seats();
  const bool expected = std::any_of(seats.begin(), seats.end(), [&](const Seat& seat) {
    return match.now_us < seat.reserved_until_us;
  });
  if (running && (expected || match.now_us < match.expected_until_us)) return;
  finish(running ? FinishReason::no_players : match.finish_reason);
}

void MatchEnd::finish(FinishReason reason) {
  MatchStatus& match = data_.match;
  if (match.state >= ServerState::closing) return;
  cases_.report_all();
  match.finish_reason = reason;
  match.enter(ServerState::closing);
  match.waiting = 0;
  const std::optional<std::uint64_t> hash = final_hash(data_);
  for (const Seat& seat : data_.roster.seats()) {
    if (seat.peer == nullptr) continue;
    data_.peers.tell(*seat.peer,
                     Finish{reason, match.confirmed, hash.has_value(), hash.value_or(0)});
  }
  data_.observer->match_finished(reason, match.confirmed, hash);
}

}  // namespace lockstone::net
