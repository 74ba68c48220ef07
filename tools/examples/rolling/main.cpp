// rolling: the whole command line for this game.
#include <lockstone/tool.h>

#include "rolling_game.h"

int main(int argc, char** argv) {
  return lockstone::tool_main(argc, argv, rolling_game());
}
