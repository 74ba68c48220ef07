#include <array>

#include "tools/arena/tags.h"
#include "tools/render/svg.h"

namespace lockstone::render {
namespace {

constexpr std::array<Color, 16> k_player_colors{{{230, 60, 60},
                                                 {60, 120, 230},
                                                 {60, 180, 75},
                                                 {245, 190, 40},
                                                 {165, 80, 200},
                                                 {40, 190, 200},
                                                 {240, 130, 50},
                                                 {230, 100, 170},
                                                 {130, 90, 60},
                                                 {150, 200, 60},
                                                 {90, 90, 160},
                                                 {200, 50, 110},
                                                 {20, 130, 120},
                                                 {120, 120, 40},
                                                 {255, 150, 130},
                                                 {80, 60, 110}}};

Color shade(Color color, int change) {
  const auto clip = [](int value) { return value < 0 ? 0 : value > 255 ? 255 : value; };
  return {clip(color.red + change), clip(color.green + change), clip(color.blue + change)};
}

Color kind_color(arena::Kind kind) {
  switch (kind) {
    case arena::Kind::crate:
      return {196, 148, 92};
    case arena::Kind::ball:
      return {222, 222, 230};
    case arena::Kind::barrel:
      return {120, 140, 150};
    case arena::Kind::snowball:
      return {245, 250, 255};
    case arena::Kind::goal:
      return {255, 210, 60};
    case arena::Kind::hill:
      return {120, 220, 140};
    case arena::Kind::ferry:
      return {150, 110, 180};
    case arena::Kind::buggy:
      return {230, 150, 40};
    case arena::Kind::bar:
      return {200, 70, 60};
    default:
      return {158, 166, 152};
  }
}

}  // namespace

Look plain_look(BodyHandle handle, const BodyView& view) {
  constexpr std::array<Color, 5> k_body_colors{
      {{214, 140, 80}, {96, 150, 200}, {120, 176, 110}, {200, 110, 120}, {160, 130, 190}}};
  const int variation = static_cast<int>(handle.index * 37 % 31) - 15;
  if (view.is_trigger) return {{255, 210, 60}, true, {}};
  const bool triangles =
      view.shape.kind == ShapeKind::mesh || view.shape.kind == ShapeKind::height_field;
  if (triangles && view.motion == MotionType::static_body) return {{188, 164, 128}, true, {}};
  if (view.motion == MotionType::static_body) return {{158, 166, 152}, true, {}};
  if (view.motion == MotionType::kinematic) return {{150, 110, 180}, true, {}};
  return {shade(k_body_colors[handle.index % k_body_colors.size()], variation), true, {}};
}

Look arena_look(BodyHandle handle, const BodyView& view) {
  const arena::Tag tag = arena::Tag::unpack(view.user_data);
  if (tag.kind == arena::Kind::player) {
    return {k_player_colors[tag.number % k_player_colors.size()], true, std::to_string(tag.number)};
  }
  const int variation = static_cast<int>(handle.index * 37 % 41) - 20;
  const Color color = kind_color(tag.kind);
  return {tag.is_loose() ? shade(color, variation) : color, true, {}};
}

}  // namespace lockstone::render
