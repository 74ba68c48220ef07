// Rotation matrices of many bodies at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/quat.h>

namespace lockstone::lanes {

/// Unit quaternions inside records of `stride_bytes`: that of record i at first + i · stride_bytes.
struct QuatField {
  const Quat* first;
  std::size_t stride_bytes;

  [[nodiscard]] const Quat* at(std::uint32_t index) const {
    return reinterpret_cast<const Quat*>(reinterpret_cast<const std::byte*>(first) +
                                         index * stride_bytes);
  }
};

/// matrices[i] = to_matrix(quats[i]) for each i of `indices`, on the target in force.
void compute_rotations(const QuatField& quats, std::span<const std::uint32_t> indices,
                       Mat3* matrices);

/// The same, one at a time.
void compute_rotations_scalar(const QuatField& quats, const std::uint32_t* indices,
                              std::size_t count, Mat3* matrices);

}  // namespace lockstone::lanes
