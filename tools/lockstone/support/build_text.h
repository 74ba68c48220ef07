// This program's build and machine, in 64 characters: for reports of states that differ.
#pragma once

#include <string>

namespace lockstone::tool {

/// `lockstone 0.1.0, 12.2.0, AMD EPYC 9R14`.
[[nodiscard]] std::string build_text();

}  // namespace lockstone::tool
