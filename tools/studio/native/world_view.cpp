// The world of a game that runs elsewhere, made from its description.
#include <memory>
#include <span>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"
#include "tools/studio/native/lockstone_studio.h"
#include "tools/watch/world_description.h"

lks_status lks_studio_described_world(const void* bytes, size_t count, lks_world** out) {
  using namespace lockstone;
  return c::call([&] {
    c::required(out, "out");
    const auto* begin = static_cast<const std::byte*>(bytes);
    Result<World> described = watch::described_world(std::span(begin, count));
    if (!described.ok()) c::throw_failure(described.status());
    auto world = std::make_unique<lks_world>();
    world->own.emplace(std::move(described).value());
    *out = world.release();
  });
}
