// The machine and build of a measurement, and the output of other programs.
#pragma once

#include <functional>
#include <string>

namespace lockstone::bench {

/// The processor's name where the system tells it.
[[nodiscard]] std::string machine_text();

/// "g++ 12.2.0"
[[nodiscard]] std::string compiler_text();

/// Of the repository around the working directory, "-dirty" after it when something is changed;
/// "unknown" without one.
[[nodiscard]] std::string commit_text();

/// In single quotes for a shell.
[[nodiscard]] std::string quoted(const std::string& text);

/// Runs a shell command and hands over each line that it prints. Its exit code; −1 when it cannot
/// be run or was killed.
int for_lines_of(const std::string& command, const std::function<void(std::string&&)>& take);

/// This program's own file, to be run again; "lockstone" where the system does not tell.
[[nodiscard]] std::string own_program();

}  // namespace lockstone::bench
