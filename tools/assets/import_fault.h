// Why a file could not be imported, and where.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lockstone::assets {

struct ImportFault {
  std::uint32_t line = 0;  ///< of the file, from 1; 0 when no line is to blame
  std::string reason;
};

/// Nothing when the import succeeded.
using ImportOutcome = std::optional<ImportFault>;

}  // namespace lockstone::assets
