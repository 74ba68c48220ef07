// Names of the interface's enumerators, for logs.

#include <array>

#include <lockstone/world.h>

namespace lockstone {
namespace {

template <class Enum, std::size_t N>
std::string_view name_of(const std::array<std::string_view, N>& names, Enum value, int first = 0) {
  const std::size_t index = static_cast<std::size_t>(value) - static_cast<std::size_t>(first);
  return index < N ? names[index] : "unknown";
}

}  // namespace

std::string_view to_string(MotionType motion) {
  constexpr std::array<std::string_view, 3> k_names{"static", "kinematic", "dynamic"};
  return name_of(k_names, motion, 1);
}
std::string_view to_string(CombineRule rule) {
  constexpr std::array<std::string_view, 6> k_names{"standard", "average",  "geometric mean",
                                                    "minimum",  "multiply", "maximum"};
  return name_of(k_names, rule);
}
std::string_view to_string(JointKind kind) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(k_last_joint_kind)> k_names{
      "distance", "ball",   "hinge", "slider", "weld",    "wheel", "motor",
      "six-axis", "pulley", "gear",  "rack",   "ratchet", "path"};
  return name_of(k_names, kind, 1);
}
std::string_view to_string(WheelCast cast) {
  constexpr std::array<std::string_view, 2> k_names{"ray", "sphere"};
  return name_of(k_names, cast);
}
std::string_view to_string(VehicleKind kind) {
  constexpr std::array<std::string_view, 3> k_names{"car", "motorcycle", "tracked"};
  return name_of(k_names, kind);
}
std::string_view to_string(AxisMode mode) {
  constexpr std::array<std::string_view, 3> k_names{"locked", "free", "limited"};
  return name_of(k_names, mode);
}
std::string_view to_string(EventKind kind) {
  constexpr std::array<std::string_view, 9> k_names{
      "contact begin", "contact end", "trigger enter", "trigger stay",   "trigger exit",
      "impact",        "sleep",       "wake",          "contact persist"};
  return name_of(k_names, kind);
}
std::string_view to_string(BroadPhaseKind kind) {
  constexpr std::array<std::string_view, 2> k_names{"tree", "sweep and prune"};
  return name_of(k_names, kind);
}
std::string_view to_string(InputOrigin origin) {
  constexpr std::array<std::string_view, 4> k_names{"received", "repeated", "neutral", "absent"};
  return name_of(k_names, origin);
}
std::string_view to_string(SnapshotKind kind) {
  constexpr std::array<std::string_view, 2> k_names{"native", "canonical"};
  return name_of(k_names, kind);
}
std::string_view to_string(DebugState state) {
  constexpr std::array<std::string_view, 5> k_names{"static", "kinematic", "awake", "asleep",
                                                    "trigger"};
  return name_of(k_names, state);
}
std::string_view to_string(TaskPieces pieces) {
  constexpr std::array<std::string_view, 2> k_names{"worthwhile", "smallest"};
  return name_of(k_names, pieces);
}
std::string_view to_string(ProfileDetail detail) {
  constexpr std::array<std::string_view, 2> k_names{"stages", "pairs"};
  return name_of(k_names, detail);
}
std::string_view to_string(StateStore store) {
  constexpr std::array<std::string_view, 3> k_names{"bodies", "contacts", "joints"};
  return name_of(k_names, store);
}
std::string_view to_string(Frame frame) {
  constexpr std::array<std::string_view, 2> k_names{"world", "body"};
  return name_of(k_names, frame);
}

std::string_view name_of(const Command& command) {
#define LKS_COMMAND_NAME(Name) , std::string_view(#Name)
  constexpr std::array k_names{std::string_view("no command") LKS_COMMANDS(LKS_COMMAND_NAME)};
#undef LKS_COMMAND_NAME
  return k_names[command.index()];
}

}  // namespace lockstone
