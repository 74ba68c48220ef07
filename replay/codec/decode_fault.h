// The result of a decoder: ok, or the fault in the bytes and its place.
#pragma once

#include <cstddef>

#include <lockstone/status.h>

namespace lockstone::replay {

struct DecodeFault {
  Status status = Status::ok;
  std::size_t position = 0;  ///< within the decoded bytes
  const char* what = "";

  [[nodiscard]] bool ok() const { return status == Status::ok; }
};

[[nodiscard]] inline DecodeFault malformed(std::size_t position, const char* what) {
  return {Status::malformed, position, what};
}

}  // namespace lockstone::replay
