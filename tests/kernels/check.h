// The comparison of every target with the scalar twins, without a test framework, so that it also
// runs as a small program under an emulator.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace lockstone::lanes::test {

/// Each returns the differences found, one a line; empty when there is none.
[[nodiscard]] std::string check_operations(std::uint64_t seed);
[[nodiscard]] std::string check_memory_operations(std::uint64_t seed);
[[nodiscard]] std::string check_contact_rows(std::uint64_t seed);
[[nodiscard]] std::string check_rotations(std::uint64_t seed);
[[nodiscard]] std::string check_points(std::uint64_t seed);
[[nodiscard]] std::string check_manifolds(std::uint64_t seed);
[[nodiscard]] std::string check_balls(std::uint64_t seed);
[[nodiscard]] std::string check_boxes(std::uint64_t seed);
[[nodiscard]] std::string check_proximal(std::uint64_t seed);

/// Runs `check` on every target, names those where it finds something, and leaves the best in
/// force.
[[nodiscard]] std::string on_each_target(const std::function<std::string()>& check);

}  // namespace lockstone::lanes::test
