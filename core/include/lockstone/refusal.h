// Why a definition or a command is refused, in words.
#pragma once

#include <string>

namespace lockstone {

/// The first field that is wrong. For people: its text may change, and making it may allocate.
struct [[nodiscard]] Refusal {
  std::string field;  ///< "body.shape.radius"; empty: nothing is wrong
  std::string value;  ///< "0 m"
  std::string rule;   ///< "must be 0.000977 … 512 m"

  /// Whether something is wrong.
  [[nodiscard]] explicit operator bool() const { return !field.empty(); }

  /// "body.shape.radius: 0 m, must be 0.000977 … 512 m"; "nothing is wrong" without a field.
  [[nodiscard]] std::string to_line() const;
};

}  // namespace lockstone
