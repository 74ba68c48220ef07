// librolling_game.so: the same game for `lockstone --game`.
#include <lockstone/game_library.h>

#include "rolling_game.h"

LOCKSTONE_GAME_LIBRARY(rolling_game)
