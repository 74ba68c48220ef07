// Verification of logs.
#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

#include "tools/bindings/c/call.h"
#include "tools/bindings/c/log_report.h"
#include "tools/scenes/play.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_log_report raw_of(const replay::VerifyReport& report) {
  lks_log_report raw{};
  raw.size = sizeof raw;
  raw.outcome = static_cast<std::uint32_t>(report.outcome);
  raw.start_tick = report.start_tick;
  raw.ticks_verified = report.ticks_verified;
  raw.final_hash = report.final_hash;
  if (report.divergence) {
    raw.diverged_tick = report.divergence->tick;
    raw.expected = report.divergence->expected;
    raw.actual = report.divergence->actual;
  }
  raw.complete = report.complete ? 1 : 0;
  raw.torn_tail = report.torn_tail ? 1 : 0;
  write_text(report.to_line(), raw.line, sizeof raw.line);
  return raw;
}

}  // namespace

void lockstone::c::verify(replay::Source& source, const SimulationFactory& make,
                          lks_log_report& report) {
  check_size<lks_log_report>(report.size, "report");
  give(raw_of(replay::verify(source, make)), &report, report.size, "report");
}

lks_status lks_verify_log(const char* path, lks_log_report* report) {
  return call([&] {
    required(report, "report");
    auto source = replay::FileSource::open(&required(path, "path"));
    if (!source.ok()) {
      throw_status(static_cast<lks_status>(source.status()),
                   std::string(path) + ": " + std::string(to_string(source.status())));
    }
    verify(*source.value(), scenes::make_simulation, *report);
  });
}

lks_status lks_verify_log_bytes(const void* bytes, size_t count, lks_log_report* report) {
  return call([&] {
    required(report, "report");
    array(bytes, count, "bytes");
    replay::MemorySource source({static_cast<const std::byte*>(bytes), count});
    verify(source, scenes::make_simulation, *report);
  });
}
