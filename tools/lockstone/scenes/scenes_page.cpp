#include "tools/lockstone/scenes/scenes_page.h"

#include <cctype>
#include <filesystem>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "tools/lockstone/support/output_file.h"
#include "tools/render/svg.h"

namespace lockstone::tool {
namespace {

// The tick that shows most of a scene, where that is not the middle of its golden run.
std::uint64_t tick_of(const scenes::SceneSummary& scene) {
  static const std::map<std::string_view, std::uint64_t> k_ticks{
      {"bullets", 6}, {"vehicle", 60}, {"spin", 20}, {"wall", 60}, {"hulls", 200}};
  const auto found = k_ticks.find(scene.name);
  return found == k_ticks.end() ? scene.golden_ticks / 2 : found->second;
}

std::string picture_of(const scenes::SceneSummary& scene) {
  const auto play = scenes::make_play(scene.name, 1).value();
  while (play->simulation().tick() < tick_of(scene))
    play->step();
  render::Picture picture{.width = 480, .height = 320};
  if (scene.name == "arena") picture.style = render::arena_look;
  return render::draw(play->world(), picture);
}

std::string entry(const scenes::SceneSummary& scene, const std::string& folder) {
  std::string sentence(scene.description);
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return fmt::format(
      "\n## {0}\n\n{1}.\n\n![{0}]({2}/{0}.svg)\n\n{3} bodies at the beginning; the picture shows "
      "tick {4}.\n",
      scene.name, sentence, folder, scenes::count_bodies(scene), tick_of(scene));
}

constexpr std::string_view k_head =
    "# Scenes\n\n"
    "The built-in scenes, which tests, benchmarks and the command share. `lockstone scenes` lists "
    "them, and `lockstone run --scene NAME\n"
    "--ticks N --svg OUT.svg --frames 6` draws one. This page and its pictures are written by "
    "`lockstone scenes --page docs/scenes.md --force`.\n";

}  // namespace

bool write_scenes_page(std::span<const scenes::SceneSummary> list, const std::string& path,
                       bool force) {
  const std::filesystem::path page(path);
  const std::string folder = page.stem().string();
  std::error_code ignored;
  std::filesystem::create_directories(page.parent_path() / folder, ignored);
  std::string text(k_head);
  for (const scenes::SceneSummary& scene : list) {
    const std::filesystem::path picture =
        page.parent_path() / folder / (std::string(scene.name) + ".svg");
    if (!write_text_file({picture.string(), force}, picture_of(scene))) return false;
    text += entry(scene, folder);
  }
  return write_text_file({path, force}, text);
}

}  // namespace lockstone::tool
