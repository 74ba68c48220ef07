// Linked into the module of plain worlds in place of the library's own functions: features that
// only the larger modules have. Assets, vehicles, fluids, changes of terrain, tapered capsules and
// rounded boxes are refused there, as in every program that does not link them; states with them as
// well.

#include <cstdio>

#define LKS_LINKS_ALL_ROWS
#include "core/geometry/distance/epa/taper_overlap.h"
#include "core/geometry/distance/gjk/taper_gap.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/commands/terrain_changes.h"
#include "core/world/phases/vehicle/vehicle_phase.h"

namespace lockstone {

#define LKS_LEFT_OUT(Command)                       \
  Status CommandExecutor::execute(const Command&) { \
    return Status::invalid_argument;                \
  }
LKS_LEFT_OUT(SetFluid)
LKS_LEFT_OUT(SetVehicle)
LKS_LEFT_OUT(DriveVehicle)
LKS_LEFT_OUT(SetHeights)
LKS_LEFT_OUT(SetMeshGroup)
#undef LKS_LEFT_OUT

const VehiclePhase* linked_vehicle_phase = nullptr;
bool is_valid(const VehicleDef&) {
  return false;
}
VehicleDef def_of(const VehicleRecord&) {
  return {};
}
VehicleRecord record_of(std::uint32_t, const VehicleDef&) {
  return {};
}
VehicleControls controls_of(const VehicleRecord&) {
  return {};
}
void set_controls(VehicleRecord&, const VehicleControls&) {}
bool can_be_chassis(const WorldData&, std::uint32_t) {
  return false;
}

HeightsFault fault_of(const WorldData&, const SetHeights&) {
  return HeightsFault::nothing;
}
bool has_room_for(const WorldData&, const SetHeights&) {
  return false;
}
bool has_room_for(const WorldData&, const SetMeshGroup&) {
  return false;
}
bool has_group(const WorldData&, const SetMeshGroup&) {
  return false;
}
const geometry::AssetGeometry* geometry_of(const World&, BodyHandle) {
  return nullptr;
}

// Of the kinds that are linked by name, these alone.
bool link_all_shapes() {
  return geometry::find_traits(ShapeKind::cylinder) == &geometry::k_cylinder &&
         geometry::find_traits(ShapeKind::cone) == &geometry::k_cone;
}

namespace geometry {

CoreOverlap taper_overlap(GapQuery&) {
  return {};
}
TaperGap taper_gap(const ConvexCore&, const ConvexCore&, const RawVec&) {
  return {};
}
CoreGap taper_point_core_gap(const ConvexCore&, const ConvexCore&, const RawVec&) {
  return {};
}

}  // namespace geometry
}  // namespace lockstone

// The module has no output: a failed check ends it without a text.
extern "C" {

[[noreturn]] void abort_message(const char*, ...) {
  __builtin_trap();
}
int fprintf(FILE*, const char*, ...) {
  return 0;
}
int fiprintf(FILE*, const char*, ...) {
  return 0;
}
int snprintf(char* out, std::size_t capacity, const char*, ...) {
  if (capacity != 0) *out = '\0';
  return 0;
}

}  // extern "C"
