#include "replay/verifying/verification.h"

#include <utility>

#include "replay/bytes/text.h"

namespace lockstone::replay {
std::vector<FieldMismatch> compare_info(const SimulationInfo& log, const SimulationInfo& here) {
  std::vector<FieldMismatch> mismatches;
  const auto field = [&](const char* name, auto in_log, auto in_build, auto to_text) {
    if (in_log != in_build) mismatches.push_back({name, to_text(in_log), to_text(in_build)});
  };
  const auto decimal = [](auto value) { return std::to_string(value); };
  field("abi", log.abi, here.abi, decimal);
  field("config hash", log.config_hash, here.config_hash, to_hex);
  field("scene hash", log.scene_hash, here.scene_hash, to_hex);
  field("canary", log.canary, here.canary, to_hex);
  field("tick rate", log.tick_rate, here.tick_rate, decimal);
  field("player count", log.player_count, here.player_count, decimal);
  field("input bytes", log.input_bytes, here.input_bytes, decimal);
  return mismatches;
}

VerifyReport Verification::run() {
  if (reader_.open() != Status::ok) {
    conclude(LogItem::damaged);
    return std::move(report_);
  }
  report_.start_tick = reader_.header().match.start_tick;
  LogItem item = reader_.next();
  while (!is_last(item) && report_.outcome != VerifyOutcome::incompatible) {
    take(item);
    if (at_end(item)) return std::move(report_);
    item = reader_.next();
  }
  if (report_.outcome != VerifyOutcome::incompatible) conclude(item);
  return std::move(report_);
}

// The keyframe there is the next segment's to load; that its hash is the one reached, the reader
// has checked.
bool Verification::at_end(LogItem item) const {
  return item == LogItem::keyframe && segment_.end &&
         segment_.end->offset == reader_.chunk_offset();
}

void Verification::take(LogItem item) {
  switch (item) {
    case LogItem::scene:
      return take_scene();
    case LogItem::hashes:
      return take_ticks();
    case LogItem::keyframe:
      return take_keyframe();
    case LogItem::end:
      report_.end_reason = reader_.end().reason;
      report_.end_kind = reader_.end().kind;
      report_.transcript = reader_.end().transcript;
      return;
    default:
      return;
  }
}

void Verification::take_scene() {
  config_.assign(reader_.config().begin(), reader_.config().end());
  Result<std::unique_ptr<Simulation>> made = factory_(config_);
  if (!made || made.value() == nullptr) {
    const Status status = made.ok() ? Status::invalid_argument : made.status();
    return refuse(status, "the simulation refuses the configuration");
  }
  simulation_ = std::move(made).value();
  report_.mismatches = compare_info(reader_.header().info, simulation_->info());
  if (!report_.mismatches.empty()) report_.outcome = VerifyOutcome::incompatible;
  reader_.bound_snapshots(simulation_->snapshot_bytes_max(SnapshotKind::canonical));
  if (!running() || !segment_.begin) return;
  // A place beyond the log shows in the item that comes next.
  static_cast<void>(reader_.jump(*segment_.begin));
  starts_at_keyframe_ = true;
}

void Verification::take_ticks() {
  if (!running() && !explaining_) return;
  const std::uint64_t first_tick = reader_.chunk().first_tick;
  for (std::size_t i = 0; i < reader_.hashes().size(); ++i) {
    step_tick(*simulation_, reader_.tick_inputs(i), reader_.tick_commands(i));
    if (explaining_) continue;
    const std::uint64_t expected = reader_.hashes()[i];
    const std::uint64_t actual = simulation_->hash();
    if (actual == expected) {
      ++report_.ticks_verified;
      report_.final_hash = actual;
      continue;
    }
    diverge(first_tick + i, expected, actual);
    explaining_ = options_.explain;
    if (!explaining_) return;
  }
  if (counter_) counter_(reader_.hashes().size());
}

void Verification::take_keyframe() {
  if (explaining_) return explain();
  if (!running()) return;
  if (at_end(LogItem::keyframe)) return;
  const bool at_start =
      starts_at_keyframe_ || (report_.ticks_verified == 0 && report_.start_tick > 0);
  starts_at_keyframe_ = false;
  return at_start ? start_from_keyframe() : check_keyframe();
}

void Verification::start_from_keyframe() {
  const Status status = simulation_->load(SnapshotKind::canonical, reader_.snapshot());
  if (status != Status::ok)
    return refuse(status, "the simulation refuses the keyframe to start from");
  const std::uint64_t tick = reader_.chunk().first_tick;
  if (simulation_->tick() != tick) {
    return refuse(Status::incompatible, "the keyframe is of another tick");
  }
  if (simulation_->hash() == reader_.keyframe_hash()) return;
  diverge(tick, reader_.keyframe_hash(), simulation_->hash());
  report_.divergence->in_keyframe = true;
}

// The ticks so far agree; does the snapshot hold the same state? This catches a field that the hash
// covers and the snapshot forgets.
void Verification::check_keyframe() {
  if (scratch_ == nullptr) {
    Result<std::unique_ptr<Simulation>> made = factory_(config_);
    if (!made || made.value() == nullptr) {
      return refuse(Status::incompatible, "the simulation refuses the configuration a second time");
    }
    scratch_ = std::move(made).value();
  }
  const Status status = scratch_->load(SnapshotKind::canonical, reader_.snapshot());
  if (status != Status::ok) return refuse(status, "the simulation refuses a keyframe");
  const std::uint64_t expected = reader_.keyframe_hash();
  const std::uint64_t stepped = simulation_->hash();
  const std::uint64_t loaded = scratch_->hash();
  if (stepped == expected && loaded == expected) return;
  diverge(reader_.chunk().first_tick, expected, loaded == expected ? stepped : loaded);
  report_.divergence->in_keyframe = true;
  if (options_.explain) explain();
}

void Verification::explain() {
  explaining_ = false;
  std::vector<std::byte> here(simulation_->snapshot_bytes_max(SnapshotKind::canonical));
  here.resize(simulation_->save(SnapshotKind::canonical, here));
  StateDifference difference = simulation_->describe(here, reader_.snapshot());
  if (!difference.differs) return;
  report_.divergence->difference = std::move(difference);
  report_.divergence->difference_tick = reader_.chunk().first_tick;
}

void Verification::diverge(std::uint64_t tick, std::uint64_t expected, std::uint64_t actual) {
  report_.outcome = VerifyOutcome::diverged;
  Divergence& divergence = report_.divergence.emplace();
  divergence.tick = tick;
  divergence.expected = expected;
  divergence.actual = actual;
}

void Verification::refuse(Status status, const std::string& what) {
  report_.outcome = VerifyOutcome::incompatible;
  report_.damage = Damage{status, reader_.chunk_offset(), reader_.chunk().type,
                          what + ": " + std::string(to_string(status))};
}

void Verification::conclude(LogItem last) {
  report_.complete = reader_.complete();
  report_.torn_tail = last == LogItem::torn;
  if (last != LogItem::finished) report_.damage = reader_.damage();
  if (!running()) return;
  if (last == LogItem::damaged) {
    const bool newer = reader_.damage().status == Status::unsupported_version;
    report_.outcome = newer ? VerifyOutcome::incompatible : VerifyOutcome::corrupt;
  }
  if (options_.strict && (last == LogItem::torn || !report_.complete)) {
    report_.outcome = VerifyOutcome::corrupt;
  }
}

}  // namespace lockstone::replay
