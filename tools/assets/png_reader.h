// PNG files of 16-bit greyscale: terrains.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/bytes.h>

#include "tools/assets/import_fault.h"

namespace lockstone::assets {

struct GreyImage {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<std::uint16_t> samples;  ///< row by row from the top
};

/// Reads a whole file, as it is stored: no gamma. Both sides within 2 … k_max_height_field_samples.
[[nodiscard]] ImportOutcome read_png(ByteView file, GreyImage& image);

}  // namespace lockstone::assets
