#include "core/dynamics/step/substep_schedule.h"

#include <vector>

#include <gtest/gtest.h>

namespace lockstone {
namespace {

std::vector<StageKind> kinds_of(const SubstepSchedule& schedule) {
  std::vector<StageKind> kinds;
  for (const Stage& stage : schedule.stages())
    kinds.push_back(stage.kind);
  return kinds;
}

TEST(SubstepSchedule, SolvesBeforePositionsMoveAndRelaxesAfter) {
  SubstepSchedule schedule(2);
  TickWork work;
  work.bodies = work.staged_bodies = 5;
  work.contact_blocks[0] = 1;
  schedule.plan_substeps(work);
  const std::vector<StageKind> two = {
      StageKind::velocities,  StageKind::solve,       StageKind::positions,
      StageKind::relax,       StageKind::note_pushes, StageKind::limit_gains,
      StageKind::velocities,  StageKind::note_pushes, StageKind::limit_repeats,
      StageKind::solve,       StageKind::positions,   StageKind::relax,
      StageKind::note_pushes, StageKind::limit_gains};
  EXPECT_EQ(kinds_of(schedule), two);
  EXPECT_EQ(schedule.stages()[0].substep, 0);
  EXPECT_EQ(schedule.stages()[11].substep, 1);
}

TEST(SubstepSchedule, OnlyRelaxesWhereAllContactsAreConverged) {
  SubstepSchedule schedule(1);
  TickWork work;
  work.contact_blocks[0] = work.converged = 1;
  work.iterates = false;
  schedule.plan_substeps(work);
  const std::vector<StageKind> expected = {StageKind::push_islands, StageKind::relax,
                                           StageKind::relax_islands, StageKind::end_islands};
  EXPECT_EQ(kinds_of(schedule), expected);
}

TEST(SubstepSchedule, SolvesWholeIslandsOnceAfterTheSubstepsOfOthers) {
  SubstepSchedule schedule(2);
  TickWork work;
  work.staged_bodies = 3;
  work.contact_blocks[0] = 1;
  work.whole = 4;
  work.iterates = work.relaxes = false;
  schedule.plan_substeps(work);
  const std::vector<StageKind> expected = {StageKind::velocities, StageKind::positions,
                                           StageKind::velocities, StageKind::positions,
                                           StageKind::whole_islands};
  EXPECT_EQ(kinds_of(schedule), expected);
}

TEST(SubstepSchedule, LimitsTheEnergyOfWatchedIslandsBeforePositionsMoveAndAfter) {
  SubstepSchedule schedule(1);
  TickWork work;
  work.staged_bodies = work.watched = 2;
  work.has_joints = true;
  schedule.plan_substeps(work);
  const std::vector<StageKind> expected = {StageKind::note_energies,  StageKind::velocities,
                                           StageKind::limit_moves,    StageKind::positions,
                                           StageKind::limit_energies, StageKind::end_joints};
  EXPECT_EQ(kinds_of(schedule), expected);
}

TEST(SubstepSchedule, HasNoStageForAbsentWork) {
  SubstepSchedule schedule(4);
  schedule.plan_substeps({});
  EXPECT_TRUE(schedule.stages().empty());
  schedule.plan_preparation({});
  EXPECT_TRUE(schedule.stages().empty());
}

TEST(SubstepSchedule, BouncesOnceAfterTheLastSubstep) {
  SubstepSchedule schedule(3);
  TickWork work;
  work.bodies = 1;
  work.bounces = true;
  work.contact_blocks[2] = 1;
  schedule.plan_substeps(work);
  const std::vector<StageKind> kinds = kinds_of(schedule);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), StageKind::bounce), 1);
  EXPECT_EQ(kinds.back(), StageKind::bounce);
  EXPECT_EQ(schedule.stages().back().color, 2);
}

TEST(SubstepSchedule, RunsTheOverflowColourAsOnePiece) {
  SubstepSchedule schedule(1);
  TickWork work;
  work.contact_blocks[k_overflow_color] = 100;
  schedule.plan_store(work);
  int pieces = 0;
  Parallel parallel;
  schedule.run(parallel, [&](const Stage& stage, std::size_t first, std::size_t end) {
    ++pieces;
    EXPECT_EQ(stage.kind, StageKind::store);
    EXPECT_EQ(first, 0U);
    EXPECT_EQ(end, 100U);
  });
  EXPECT_EQ(pieces, 1);
}

}  // namespace
}  // namespace lockstone
