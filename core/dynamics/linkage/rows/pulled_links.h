// How hard joints pull their bodies, and the inertia that keeps hard pulled links stable.
//
// A link that is pulled at both ends by T swings at ω² = ΣT·r / I, which the step does not resolve
// where h·ω is large: there links are taken to be heavier to turn. A diagonal form of the geometric
// stiffness: S. Andrews, M. Teichmann, J. Kövecses, "Geometric Stiffness for Real-time Constrained
// Multibody Dynamics", 2017.
#pragma once

#include <span>

#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

/// As a joint is added: sums how hard it pulled its bodies in the last tick.
void note_last_pull(JointSystem& system, AddedJoint& joint);

/// When all joints are added: marks the bodies that joints pulled hard in the last tick.
void find_pulled_links(JointSystem& system);

/// At a tick's beginning: sums the pulls of joints, those left to the coloured balls included, and
/// sets the inertia of all bodies.
void resist_pulls(const JointRun& run, JointSystem& system);

/// After positions moved: alike, for the bodies of a cluster.
void resist_pulls(const JointRun& run, JointSystem& system, const JointCluster& cluster);

/// The inertia, besides its own, that a body has when its joints swing against each other, Q30:
/// m·d², with d from the centre of mass to the middle of its two anchors, or to its one anchor;
/// with one anchor in the measure in which the other body stands still.
[[nodiscard]] std::int64_t lever_inertia(const JointSystem& system, std::uint32_t body);

}  // namespace lockstone
