/* pushers: the whole command line for this game. */
#include <lockstone/game_abi.h>

int main(int argc, char **argv) { return lockstone_tool_main(argc, argv, lockstone_game()); }
