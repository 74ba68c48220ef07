// Makes good logs of damaged ones, and short ones of long ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <lockstone/replay/format.h>
#include <lockstone/replay/sink.h>
#include <lockstone/replay/source.h>
#include <lockstone/simulation.h>

namespace lockstone::replay {

struct RepairReport {
  Status status = Status::ok;  ///< not ok: nothing could be saved, or not written
  std::string what;            ///< one line for people when it is not ok
  bool was_whole = false;      ///< the log had its END: all bytes were copied as they are
  std::optional<Damage> damage;
  std::uint64_t kept_ticks = 0;
  std::uint64_t kept_bytes = 0;  ///< copied unchanged, so that signatures in them stay good
  std::uint64_t lost_bytes = 0;
};

/// Copies everything up to the end of the last whole tick before the first damage, and closes it
/// with an INDEX and an END whose reason is "repaired: " and the damage. Nothing is simulated.
[[nodiscard]] RepairReport repair(Source& damaged, Sink& sink);

struct CutReport {
  Status status = Status::ok;
  std::string what;
  std::uint64_t ticks = 0;
};

/// Records the ticks from `begin` up to, not with, `end` as a log of its own, which starts with a
/// keyframe at `begin`, and whose END says that it was cut. The inputs and hashes are the recorded
/// ones; the simulation is stepped to `begin` only, and must agree with the log there: else
/// incompatible. Events are left out. invalid_argument unless begin < end; not_found when the log
/// has no tick `begin`; the status of the damage where there is damage before `end`. After an error
/// `sink` may hold the beginning of a log, which is of no use.
[[nodiscard]] CutReport cut(Source& source, const SimulationFactory& factory, std::uint64_t begin,
                            std::uint64_t end, Sink& sink, bool compress = true);

}  // namespace lockstone::replay
