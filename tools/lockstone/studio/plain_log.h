// Logs as the studio's page reads them.
#pragma once

#include <optional>
#include <string>

#include <lockstone/replay/source.h>

namespace lockstone::tool {

/// The bytes of the same log without compression, which the page cannot undo; of a damaged or torn
/// one, the good part. Nothing where it has none.
[[nodiscard]] std::optional<std::string> plain_log(replay::Source& source);

}  // namespace lockstone::tool
