// Finds the islands that are pressed between two bodies that no impulse moves: by one that moves,
// or overlaps them deeply. No impulses satisfy their constraints: they would grow without limit.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Where a body of the world that no impulse moves pushes an island, along the normal.
struct ImmovablePush {
  std::uint32_t island = 0;  // 0: none
  std::uint32_t body = 0;
  Vec3<Unit> normal{};

  friend bool operator==(const ImmovablePush&, const ImmovablePush&) = default;
  [[nodiscard]] auto key() const {
    return std::tuple(island, body, normal.x.raw, normal.y.raw, normal.z.raw);
  }
};

class PinchedIslands {
 public:
  /// No function but this allocates.
  [[gnu::cold]] explicit PinchedIslands(std::size_t contact_capacity);

  void clear() { pressing_.clear(); }
  /// A push by a body that moves or overlaps deeply. At most one for each contact.
  void add_pressing(const ImmovablePush& push);
  [[nodiscard]] bool has_pressing() const { return !pressing_.empty(); }

  /// Once all are added, and before the first question.
  void sort();
  /// Whether such a body pushes the island against this push, of another body.
  [[nodiscard]] bool is_pinched(const ImmovablePush& push) const;

 private:
  std::vector<ImmovablePush> pressing_;  // by island
};

}  // namespace lockstone
