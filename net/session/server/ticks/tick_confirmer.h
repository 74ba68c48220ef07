// Makes the inputs of one tick after another final, on schedule.
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/bytes.h>

#include "net/session/server/data/resume_wait.h"
#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/leaving/match_end.h"
#include "net/session/server/ticks/command_intake.h"
#include "net/session/server/ticks/input_intake.h"
#include "net/session/server/ticks/laggards.h"

namespace lockstone::net {

/// Confirms ticks when they are due, or, where the match waits for inputs, when these are here; and
/// steps the server's own simulation with them.
class TickConfirmer {
 public:
  /// The parts of the server that it uses.
  struct Uses {
    const DesyncCases& cases;
    EntryStates& states;
    InputIntake& inputs;
    CommandIntake& commands;
    Laggards& laggards;
    MatchEnd& end;
  };
  TickConfirmer(ServerData& data, const Uses& uses)
      : data_(data), uses_(uses), resumed_(data.config.timeouts.drop_us) {}

  /// Goes on after the ticks that the simulation has stepped already, as if this server had
  /// confirmed them, and lost all players.
  void resume();

  /// Confirms all ticks that are due.
  void advance();

 private:
  [[nodiscard]] bool may_confirm_next();
  [[nodiscard]] bool awaits_return();
  void confirm_next();
  [[nodiscard]] std::optional<std::uint64_t> step_simulation(ByteView record);

  ServerData& data_;
  Uses uses_;
  ResumeWait resumed_;
};

}  // namespace lockstone::net
