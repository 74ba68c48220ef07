// Rows of joints with an equation of their own instead of six axes: one row each.
#pragma once

#include "core/dynamics/joint/joint_row_writer.h"

namespace lockstone {

/// The distance of the anchors: locked, limited or driven.
void fill_distance(RowWriter& rows, const JointArms& arms);

/// The length of a rope from ground point to anchor of both bodies, that of b times the ratio.
void fill_pulley(RowWriter& rows, const JointArms& arms);

/// The turning of b about its x axis is that of a about its own, times the ratio.
void fill_gear(RowWriter& rows);

/// The motion of b along its x axis follows the turning of a about its own.
void fill_rack(RowWriter& rows, const JointArms& arms);

}  // namespace lockstone
