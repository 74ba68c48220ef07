// Figures of an engine's run of a scene.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tools/bench/general/engine.h"

namespace lockstone::bench {

/// The figure when a body or a number is lost; no figure is greater.
inline constexpr double k_lost_figure = 1e6;

struct GeneralFigures {
  double error = 0;  ///< as the scene's judge says
  double gap = 0;    ///< m, the widest of a joint at any time
  double gain = 0;  ///< the most energy regained over that of the beginning; 0 where none is judged
  double speed = 0;        ///< m/s, of the fastest centre at any time
  double rest = 0;         ///< s, until nothing moved any more; beyond the end when something does
  double asleep = 0;       ///< share of dynamic bodies at the end
  double tick_micros = 0;  ///< processor time, mean
  std::uint32_t contacts = 0;  ///< the most at any time; 0 where the engine does not count them
  std::uint64_t hash = 0;
  bool failed = false;  ///< the expected event of the scene did not happen
};

/// Energy that may be regained by rounding and by pushing bodies out.
inline constexpr double k_gain_bound = 0.05;

/// Before a tick: bodies come and go as `changes_of(scene)` says, those of the first tick excepted,
/// which an engine begins with; then velocities and gravity are set.
void begin_tick(GeneralEngine& engine, const GeneralScene& scene,
                std::span<const GeneralChange> changes, int tick);

/// Plays the scene to its end; nothing when the engine cannot.
[[nodiscard]] std::optional<GeneralFigures> play_general(const GeneralMaker& maker,
                                                         const GeneralScene& scene, int substeps);

/// Pictures of the scene through its time, as SVG; empty when the engine draws nothing.
[[nodiscard]] std::string draw_general(const GeneralMaker& maker, const GeneralScene& scene,
                                       int substeps);

}  // namespace lockstone::bench
