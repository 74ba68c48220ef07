// A body that joints connect to others, during one tick: its pose, its inertia, and the velocities
// that the stages of a substep note for it.
//
// A link that its joints pull hard may be taken to be heavier to turn than it is
// (`pulled_links.h`): then no principal moment is below `least_inertia`, and its spin in the rows
// of the solver belongs to that inertia.
#pragma once

#include <cstdint>

#include "core/dynamics/body/principal_inverse.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/state/body_record.h"
#include "core/math/block_float.h"
#include "core/math/round_divisor.h"

namespace lockstone {

struct alignas(64) LinkedBody {
  // All that planning reads, in one line of the cache.
  const BodyRecord* record = nullptr;
  std::uint32_t solver = 0;        // number in the contact solver, 0 for a body that does not move
  std::int8_t scale = 0;           // exponent
  bool rotates = false;            // as the record says
  bool is_spherical = false;       // its principal moments are equal
  bool pushed = false;             // impulses change its velocity
  bool touches = false;            // has contacts
  bool is_among_contacts = false;  // its joints are in the problem of its island's contacts
  bool in_balls = false;           // a joint of it is left to the coloured balls
  bool only_balls = false;         // so are all joints of its group: no stage notes anything
  bool centred = false;            // velocity Verlet: half a push, a move, half a push
  bool moves_first = false;        // position Verlet: half a move, a push, half a move
  bool is_whole = false;           // moved with the rest of its island
  bool pulled = false;             // an eighth as hard as needs more inertia
  bool has_principal = false;
  bool has_looked = false;

  // Its joints, and how hard they pull it.
  std::uint32_t first_joint = 0;  // in JointSystem::by_body
  std::uint32_t joint_count = 0;
  std::uint32_t local = 0;         // number in its group
  std::int64_t pull = 0;           // sum of impulses at levers, per mass and scale, Q30
  std::int64_t lever_inertia = 0;  // Q30: m·d² of its anchors, besides its own inertia
  std::int64_t least_inertia = 0;  // Q30: a power of two, or 0 for its own inertia

  // Where it is, and how heavy it is to turn: all else that moves it, in two lines. The inertia of
  // a pushed body is known once the tick begins.
  JointPose pose;
  InverseInertia inverse_inertia{};
  RoundDivisor rate{};  // 1 / the time that it moves for

  PrincipalInverse principal{};  // if it has such

  // Notes. Where it will be after the substep with its present velocity, and that velocity.
  JointPose after{};
  lanes::BodyVelocity looked{};
  InverseInertia inertia_ahead{};  // half a substep on, as far as is known
  // Velocities and energies noted by stages of the substep.
  lanes::BodyVelocity unpushed{};  // as the present stage found it
  lanes::BodyVelocity saved_row{};
  lanes::BodyVelocity start{};  // of the substep
  Vec3<Position> start_position{};
  InverseInertia start_inertia{};  // and where it was then
  Mat3 start_rotation{};
  BlockFloat mass{};            // as a part of that of its cluster's heaviest body
  bool starts_heavier = false;  // to turn than it is
};

/// Fills a new one as a tick finds the body.
void set_body(const BodyRecord& record, const Mat3& rotation, std::uint32_t solver,
              LinkedBody& body);

/// Raises the principal moments to at least this (Q30; 0, or a power of two), or lowers them again.
/// Keeps the angular velocity.
void set_least_inertia(const JointRun& run, LinkedBody& body, std::int64_t least);

/// Where the body will be after the substep with its present velocity.
[[nodiscard]] JointPose pose_after(const JointRun& run, LinkedBody& body);

/// Finds that pose, unless it is known already for this velocity.
void look_ahead(const JointRun& run, LinkedBody& body);

/// Moves the body by a substep: to the pose where it was last seen, if its velocity is the same.
void move_body(const JointRun& run, LinkedBody& body);

}  // namespace lockstone
