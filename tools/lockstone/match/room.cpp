#include "tools/lockstone/match/room.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/agones.h"
#include "tools/lockstone/match/journal.h"
#include "tools/lockstone/match/rooms.h"

namespace lockstone::tool {
namespace {

constexpr std::int64_t k_work_every_us = 2000;
constexpr std::int64_t k_metrics_every_us = 250'000;

int code_of(const MatchSummary& summary) {
  if (summary.desyncs > 0) return k_different;
  return summary.record_status == Status::ok ? k_ok : k_unavailable;
}

}  // namespace

RoomsProgram::RoomsProgram(const Games& games, const MatchOptions& match,
                           const RoomsOptions& options)
    : games_(games), match_(match), options_(options) {}

bool RoomsProgram::takes_more_locked() const {
  const bool another = options_.matches == 0 || begun_ < options_.matches;
  return !draining_ && !stopping_ && another;
}

bool RoomsProgram::takes_more() const {
  const std::lock_guard lock(mutex_);
  return takes_more_locked();
}

std::optional<MatchOptions> RoomsProgram::next() {
  const std::lock_guard lock(mutex_);
  if (!takes_more_locked()) return std::nullopt;
  MatchOptions match = match_;
  match.start.seed += begun_;
  match.match += begun_++;
  match.metrics_port = 0;
  for (std::string* file : {&match.record, &match.bundle}) {
    if (!file->empty()) *file += fmt::format(".{}", match.match);
  }
  return match;
}

void RoomsProgram::note_begun() const {
  if (options_.agones != nullptr) options_.agones->match_began();
}

void RoomsProgram::note_ended(const MatchHost& host, bool begun, int code) {
  const MatchMetrics metrics = host.metrics();
  const std::lock_guard lock(mutex_);
  ++ended_.count;
  add_up(ended_.sum, metrics);
  ended_.code = std::max(ended_.code, code);
  lateness_.add(host.lateness());
  if (begun && options_.agones != nullptr) options_.agones->match_ended(takes_more_locked());
}

void RoomsProgram::note_failed(int code) {
  draining_ = true;
  const std::lock_guard lock(mutex_);
  ended_.code = std::max(ended_.code, code);
}

EndedMatches RoomsProgram::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void Room::try_work(const Stopwatch& watch) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || closed_) return;
  const std::int64_t now_us = watch.microseconds();
  if (now_us < next_us_) return;
  next_us_ = now_us + k_work_every_us;
  work(now_us);
}

void Room::work(std::int64_t now_us) {
  if (host_ == nullptr) return open();
  obey();
  if (!host_->step()) return close();
  if (!begun_ && host_->begun()) {
    begun_ = true;
    program_.note_begun();
  }
  if (now_us >= next_metrics_us_) publish(now_us);
}

// The place of the last match is free once its packets have left: then the next try succeeds.
void Room::open() {
  if (!coming_) coming_ = program_.next();
  if (!coming_) {
    closed_ = true;
    return;
  }
  const Result<net::Transport*> line = router_.open(coming_->match);
  if (line.status() == Status::capacity_exhausted) return;
  if (!line.ok()) {  // another open match has the same tag
    coming_.reset();
    return;
  }
  line_ = line.value();
  host_ = MatchHost::create(program_.games(), *coming_, line_);
  if (host_ == nullptr) {
    router_.close(*line_);
    closed_ = true;
    return program_.note_failed(k_unavailable);
  }
  if (!coming_->silent) {
    Journal(coming_->json_log, coming_->match)
        .write({"match_open", fmt::format("match {} is open", coming_->match)});
  }
  coming_.reset();
  begun_ = drained_ = stopped_ = measured_ = false;
  next_metrics_us_ = 0;
}

void Room::obey() {
  if (program_.stopping() && !std::exchange(stopped_, true)) host_->stop();
  if (program_.draining() && !std::exchange(drained_, true)) host_->drain();
  if (program_.measuring() && !std::exchange(measured_, true)) host_->restart_lateness();
}

void Room::publish(std::int64_t now_us) {
  next_metrics_us_ = now_us + k_metrics_every_us;
  MatchMetrics metrics = host_->metrics();
  const std::lock_guard lock(metrics_mutex_);
  metrics_ = std::move(metrics);
}

void Room::close() {
  const MatchSummary summary = host_->finish();
  host_->say_summary(summary);
  program_.note_ended(*host_, begun_, code_of(summary));
  {
    const std::lock_guard lock(metrics_mutex_);
    metrics_.reset();
  }
  router_.close(*line_);
  host_.reset();
  line_ = nullptr;
}

std::optional<MatchMetrics> Room::metrics() const {
  const std::lock_guard lock(metrics_mutex_);
  return metrics_;
}

}  // namespace lockstone::tool
