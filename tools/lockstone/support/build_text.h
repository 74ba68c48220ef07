// This program's build and machine, in 64 characters: for reports of states that differ.
#pragma once

#include <string>

namespace lockstone::tool {

/// `arena 0.1, 12.2.0, AMD EPYC 9R14`, for `program` "arena 0.1".
[[nodiscard]] std::string build_text(const std::string& program);

}  // namespace lockstone::tool
