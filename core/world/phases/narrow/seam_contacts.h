// Scratch of the search for ghosts at the seams between static shapes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/collision/narrow_phase/seams.h"

namespace lockstone {

/// A contact of a moving body with a static one.
struct SeamContact {
  static constexpr std::uint32_t k_none = 0xffffffff;

  std::uint32_t id = 0;
  std::uint32_t other = 0;    ///< the static body
  Vec3<Unit> normal{};        ///< away from it
  Displacement separation{};  ///< the least
  bool has_looked = false;    ///< for the face
  std::optional<FaceOfShape> face{};
  /// The contact whose face keeps the body off this one's shape, where this one is a ghost.
  std::uint32_t ghost_of = k_none;
};

/// The contacts of one body. Beyond the capacity the last are not judged, and stay.
struct SeamContacts {
  static constexpr std::uint32_t k_capacity = 96;

  std::array<SeamContact, k_capacity> contacts{};
  std::uint32_t count = 0;

  [[nodiscard]] std::span<SeamContact> all() { return std::span(contacts).first(count); }
};

}  // namespace lockstone
