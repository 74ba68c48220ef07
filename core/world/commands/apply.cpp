// The dispatch of commands, in a file of its own: a program that gives none links none.

#include <type_traits>
#include <variant>

#include "core/world/commands/command_executor.h"
#include "core/world/world_impl.h"

namespace lockstone {

Status World::apply(const Command& command) {
  return std::visit(
      [this](const auto& c) {
        if constexpr (std::is_same_v<std::decay_t<decltype(c)>, std::monostate>) {
          return Status::invalid_argument;
        } else {
          return CommandExecutor(*impl_).execute(c);
        }
      },
      command);
}

}  // namespace lockstone
