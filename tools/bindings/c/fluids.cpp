// Fluids.
#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_fluid raw_of(const Fluid& fluid) {
  lks_fluid raw{};
  raw.size = sizeof raw;
  raw.mask = fluid.mask;
  raw.surface = c::raw_of(fluid.surface);
  raw.extents = c::raw_of(fluid.size);
  raw.flow = c::raw_of(fluid.flow);
  raw.orientation = c::raw_of(fluid.orientation);
  raw.density = fluid.density.raw;
  raw.drag = fluid.drag.raw;
  raw.linear_drag = fluid.linear_drag.raw;
  return raw;
}

Fluid fluid_of(const lks_fluid* from) {
  const lks_fluid raw = take(from, raw_of(Fluid{}), "fluid");
  Fluid fluid;
  fluid.surface = vec<Position>(raw.surface);
  fluid.orientation = quat_of(raw.orientation);
  fluid.size = vec<Position>(raw.extents);
  fluid.density = Density::from_raw(raw.density);
  fluid.drag = Number::from_raw(raw.drag);
  fluid.linear_drag = Rate::from_raw(raw.linear_drag);
  fluid.flow = vec<Velocity>(raw.flow);
  fluid.mask = raw.mask;
  return fluid;
}

}  // namespace

lks_status lks_fluid_init(lks_fluid* fluid, size_t size) {
  return call([&] { give(raw_of(Fluid{}), fluid, size, "fluid"); });
}

lks_status lks_set_fluid(lks_world* world, uint32_t number, const lks_fluid* fluid) {
  return call([&] { order(world, SetFluid{number, fluid_of(fluid)}); });
}

lks_status lks_fluid_get(const lks_world* world, uint32_t number, lks_fluid* out) {
  return call(
      [&] { give(raw_of(fluid_at(read(world), number)), out, required(out, "out").size, "out"); });
}
