// A fluid as it is stored, saved and hashed.
#pragma once

#include <cstdint>

#include <lockstone/fluid.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

/// Canonical state of one fluid; all zero where there is none.
struct FluidRecord {
  Vec3<Position> surface{};
  Vec3<Position> size{};
  Vec3<Velocity> flow{};
  Quat orientation{{}, {}, {}, {}};
  Density density{};
  Number drag{};
  Rate linear_drag{};
  std::uint32_t mask = 0;

  friend bool operator==(const FluidRecord&, const FluidRecord&) = default;

  [[nodiscard]] bool exists() const { return density > Density{}; }
};

template <class F>
constexpr void visit_fields(FluidRecord& record, F&& f) {
  visit_value("surface", "", record.surface, f);
  visit_value("size", "", record.size, f);
  visit_value("flow", "", record.flow, f);
  visit_value("orientation", "", record.orientation, f);
  visit_value("density", "", record.density, f);
  visit_value("drag", "", record.drag, f);
  visit_value("linear_drag", "", record.linear_drag, f);
  visit_value("mask", "", record.mask, f);
}

static_assert(visited_bytes<FluidRecord>() == sizeof(FluidRecord), "a field is missing");

}  // namespace lockstone
