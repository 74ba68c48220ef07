// The bodies in a character's way: those that its filter lets in, less the one-way bodies that it
// passes.
#pragma once

#include <span>

#include <lockstone/character.h>
#include <lockstone/rules.h>

namespace lockstone {

/// A one-way body stops a character that comes from its front. The character passes where it meets
/// another side, and where it is deeper inside than its skin and the body's way in a tick.
class CharacterObstacles {
 public:
  CharacterObstacles(const World& world, const CharacterDef& def) : world_(world), def_(def) {}

  /// The first obstacle on the way.
  [[nodiscard]] ShapeHit cast(const Vec3<Position>& from, const Vec3<Length>& motion) const;

  /// How the character meets obstacles nearer than `margin`; returns their number.
  std::size_t contacts(const Vec3<Position>& position, Length margin,
                       std::span<ShapeContact> out) const;

 private:
  [[nodiscard]] bool is_in_front(BodyHandle body, const OneWay& rule,
                                 const Vec3<Unit>& normal) const;
  [[nodiscard]] bool stops(const ShapeHit& hit) const;
  [[nodiscard]] bool stops(const ShapeContact& contact) const;
  [[nodiscard]] Length depth_allowed(BodyHandle body, const Vec3<Unit>& normal) const;

  const World& world_;
  const CharacterDef& def_;
};

}  // namespace lockstone
