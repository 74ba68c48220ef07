// What the subcommands that read logs share.
#pragma once

#include <lockstone/status.h>

#include "tools/lockstone/commands.h"

namespace lockstone::tool {

/// The exit code for a log that cannot be read at all.
[[nodiscard]] inline int exit_code_of(Status status) {
  const bool foreign = status == Status::unsupported_version || status == Status::incompatible;
  return foreign ? k_incompatible : k_corrupt;
}

}  // namespace lockstone::tool
