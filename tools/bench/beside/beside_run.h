// Engines side by side on one scene: the time that each takes for a tick.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/general/engine.h"
#include "tools/bench/support/measure.h"

namespace lockstone::bench {

/// An engine, and how it divides a tick.
struct BesideEngine {
  GeneralMaker maker;
  std::string name;  ///< with its setting, where it is not the same as ours
  int substeps = 4;
};

/// The engines take turns of a few ticks each, so that a machine whose speed changes is alike to
/// all.
struct BesideOptions {
  std::vector<BesideEngine> engines;  ///< ours first
  int repeats = 1;  ///< each from the beginning; a tick's time is the median over them
  Clock clock = thread_nanoseconds;
};

/// One engine's figures of one scene. Bodies that come and go do so outside the time of a tick.
struct BesideFigures {
  std::string engine;
  bool played = false;        ///< false: it cannot do the scene
  std::vector<double> ticks;  ///< ns
  double height = 0;          ///< m, the mean of dynamic bodies at the end
  double asleep = 0;          ///< the share of dynamic bodies that sleep at the end
  bool had_room = true;       ///< for all contacts, in every step

  [[nodiscard]] double mean() const;                     ///< ns a tick
  [[nodiscard]] double quantile_of(double share) const;  ///< ns
};

struct BesideRun {
  std::string scene;
  std::size_t bodies = 0;  ///< dynamic ones, all that ever come
  std::size_t joints = 0;
  int ticks = 0;
  std::string lacking;                 ///< why the scene has no figures; empty: it has
  std::vector<BesideFigures> figures;  ///< by engine, in the order of the options
};

[[nodiscard]] BesideRun play_beside(const GeneralScene& scene, const BesideOptions& options);

}  // namespace lockstone::bench
