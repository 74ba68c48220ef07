// The order of a tick's work: its loops, one after the other, whose pieces workers share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/islands/constraint_graph.h"

namespace lockstone {

/// A loop of the tick.
enum class StageKind : std::uint8_t {
  fill_bodies,
  begin_joints,
  place_joined,
  fill_balls,
  fill_contacts,
  note_energies,
  velocities,
  note_pushes,
  limit_repeats,
  warm_joints,
  first_impacts,
  solve,
  push_islands,
  solve_balls,
  solve_joints,
  limit_moves,
  positions,
  move_joined,
  relax_joints,
  update_balls,
  impacts,
  relax,
  relax_islands,
  limit_gains,
  limit_energies,
  note_impulses,
  whole_islands,
  end_islands,
  end_joints,
  keep_speeds,
  bounce,
  store,
};

struct Stage {
  StageKind kind = StageKind::velocities;
  std::uint8_t color = 0;
  std::uint8_t substep = 0;
};

/// Numbers of blocks, by colour.
using BlockCounts = std::array<std::uint32_t, k_graph_colors + 1>;

/// How much there is of each kind in a tick; a loop over none is left out.
struct TickWork {
  std::uint32_t rows = 0;           ///< of bodies
  std::uint32_t bodies = 0;         ///< numbers
  std::uint32_t staged_bodies = 0;  ///< the same, or 0 where all are of whole islands
  std::uint32_t clusters = 0;       ///< of joints
  std::uint32_t joined = 0;         ///< bodies that joints move
  std::uint32_t converged = 0;      ///< islands
  std::uint32_t whole = 0;          ///< islands that are solved whole
  std::uint32_t watched = 0;        ///< islands whose energy is limited
  bool has_joints = false;
  bool iterates = true;      ///< some contacts are of no converged island
  bool relaxes = true;       ///< some contacts are of no whole island
  bool has_impacts = false;  ///< of balls
  bool watches_impulses = false;
  bool bounces = false;
  BlockCounts contact_blocks{};
  BlockCounts ball_blocks{};  ///< of coloured ball joints
};

class SubstepSchedule {
 public:
  /// No function but this allocates.
  [[gnu::cold]] explicit SubstepSchedule(int substeps);

  [[nodiscard]] int substeps() const { return substeps_; }

  /// Bodies, then the constraints that refer to them.
  void plan_preparation(const TickWork& work);
  /// All substeps; then contacts that bounce.
  void plan_substeps(const TickWork& work);
  void plan_store(const TickWork& work);

  /// Calls `run_piece(stage, first, end)` for the pieces of all loops as planned. A loop begins
  /// when the one before has ended.
  template <class RunPiece>
  void run(Parallel& parallel, const RunPiece& run_piece) const {
    parallel.run_all(loops_, [&](std::size_t loop, std::uint32_t first, std::uint32_t end,
                                 std::uint32_t) { run_piece(stages_[loop], first, end); });
  }

  [[nodiscard]] std::span<const Stage> stages() const { return stages_; }

 private:
  void clear();
  void plan_substep(const TickWork& work, std::uint8_t substep);
  void add(Stage stage, std::uint32_t count, std::uint32_t grain);
  void add_serial(StageKind kind, bool is_due);
  void add_gain_limit(StageKind kind, const TickWork& work);
  void add_colors(Stage stage, const BlockCounts& counts);
  void add_contacts(StageKind kind, const TickWork& work, std::uint8_t substep = 0);
  void add_balls(StageKind kind, const TickWork& work);

  int substeps_;
  std::vector<Loop> loops_;
  std::vector<Stage> stages_;  // of each loop
};

}  // namespace lockstone
