// A game of a later table than the tool knows.
#include <lockstone/game_abi.h>

extern "C" LOCKSTONE_GAME_EXPORT const lockstone_game_table* lockstone_game() {
  static lockstone_game_table table{};
  table.abi = LOCKSTONE_GAME_ABI + 1;
  table.bytes = sizeof table;
  table.name = "future";
  return &table;
}
