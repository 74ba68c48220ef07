// Definitions of the opaque handles of the C interface.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/rollback_history.h>
#include <lockstone/thread_pool.h>
#include <lockstone/world.h>

#include "tools/bindings/c/call.h"
#include "tools/scenes/play.h"

/// A world of the caller's, a built-in scene, or the world of a match.
struct lks_world {
  std::unique_ptr<lockstone::ThreadPool> threads;  // outlives the world that steps on it
  std::optional<lockstone::World> own;
  std::optional<lockstone::RollbackHistory> history;  // of `own`
  std::unique_ptr<lockstone::scenes::ScenePlay> scene;
  std::shared_ptr<const lockstone::World> shown;  // of a match, which a session steps

  [[nodiscard]] const lockstone::World& world() const {
    if (shown != nullptr) return *shown;
    return scene ? scene->world() : *own;
  }
};

struct lks_assets {
  std::vector<lockstone::AssetPtr> list;
};

namespace lockstone::c {

/// Throw for null.
inline const lks_world& handle(const lks_world* world) {
  return required(world, "world");
}
inline const World& read(const lks_world* world) {
  return handle(world).world();
}

/// Throws for a scene too: a scene relies on the bodies and joints that it created.
World& write(lks_world* world);

/// Throws for the world of a match.
const lks_world& saved(const lks_world* world);

/// Applies a command; throws when it is refused.
void order(lks_world* world, const Command& command);

/// Throws when there is no such body.
BodyHandle existing_body(const World& world, lks_body body);

}  // namespace lockstone::c
