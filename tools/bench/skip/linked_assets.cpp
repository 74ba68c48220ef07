// A program that also makes a hull, a mesh and a height field.
#include <vector>

#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/load_asset.h>
#include <lockstone/world.h>

using namespace lockstone;
using namespace lockstone::literals;

int main(int count, char** arguments) {
  const std::vector<Vec3<Length>> corners{
      {{}, {}, {}}, {1_m, {}, {}}, {{}, 1_m, {}}, {{}, {}, 1_m}};
  const HullResult hull = Hull::build(corners);
  // Anything that might make the other two.
  const auto bytes = std::as_bytes(std::span(arguments[0], static_cast<std::size_t>(count)));
  const bool loaded = load_asset(bytes).ok();
  if (!hull.ok() || loaded) return 1;
  const auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{hull.hull});
  Result<World> world = World::create({.body_capacity = 8}, assets);
  return world.value().step().pairs == 0 ? 0 : 1;
}
