// Plays neutral scenes by our engine, wherever it was compiled for, and prints a line of JSON for
// each setting. The same arguments as tools/bench/peers/node/run.mjs, but for the engine's name:
// lockstone_scene_player SCENES.json REPEATS SETTING…
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tools/bench/neutral/scene_json.h"

int main(int argc, char** argv) {
  using namespace lockstone::bench;
  if (argc < 4) return 64;
  std::ifstream file(argv[1]);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::vector<NeutralScene> scenes = scenes_from_json(text);
  if (scenes.empty()) return 2;
  for (const NeutralScene& scene : scenes) {
    for (int i = 3; i < argc; ++i) {
      std::optional<Played> played = play(lockstone_maker(), scene, std::atoi(argv[i]));
      for (int left = std::atoi(argv[2]); left > 0; --left)
        time_again(lockstone_maker(), scene, *played);
      std::puts(played_to_json(*played).c_str());
    }
  }
  return 0;
}
