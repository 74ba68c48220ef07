// Makes a shared library of a game, which `lockstone --game libsumo.so …` loads.
//
//     LOCKSTONE_GAME_LIBRARY(sumo_game)  // GameDef sumo_game(); once, in one source of the library
#pragma once

#include <lockstone/game_abi.h>
#include <lockstone/tool.h>

namespace lockstone {

/// The table of the game that `make` returns. Made at the first call; every call of one program
/// returns the same table.
[[nodiscard]] const lockstone_game_table* game_table(GameDef (*make)());

}  // namespace lockstone

#define LOCKSTONE_GAME_LIBRARY(make_game)                                         \
  extern "C" LOCKSTONE_GAME_EXPORT const lockstone_game_table* lockstone_game() { \
    return lockstone::game_table(make_game);                                      \
  }
