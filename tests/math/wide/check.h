// The comparison of every target with the scalar twins, without a test framework, so that it also
// runs as a small program under an emulator.
#pragma once

#include <cstdint>
#include <string>

namespace lockstone::lanes::test {

/// Each answers the differences found, one a line; empty when there is none.
[[nodiscard]] std::string check_operations(std::uint64_t seed);
[[nodiscard]] std::string check_memory_operations(std::uint64_t seed);
[[nodiscard]] std::string check_contact_rows(std::uint64_t seed);
[[nodiscard]] std::string check_rotations(std::uint64_t seed);

}  // namespace lockstone::lanes::test
