// Opens files, and nothing else that a path may name.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include <lockstone/status.h>

namespace lockstone::replay {

enum class OpenFor : std::uint8_t {
  reading,
  replacing,  ///< an existing file is emptied
  creating,   ///< nothing may be there
};

/// not_found, or io_error: for a directory, a FIFO or a device too, and at once.
[[nodiscard]] Result<std::FILE*> open_regular(const std::string& path, OpenFor purpose);

}  // namespace lockstone::replay
