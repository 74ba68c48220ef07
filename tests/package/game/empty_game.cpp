// A game without the functions that it must have.
#include <lockstone/game_abi.h>

extern "C" LOCKSTONE_GAME_EXPORT const lockstone_game_table* lockstone_game() {
  static lockstone_game_table table{};
  table.abi = LOCKSTONE_GAME_ABI;
  table.bytes = sizeof table;
  table.name = "empty";
  return &table;
}
