// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A box of six greased plates: the cell of triaxial tests.
#pragma once

#include "experiments/lane_run.hpp"

namespace tilth {

enum BoxWall : int { box_left, box_right, box_front, box_back, box_base, box_lid };

/// Six plates around [0, size]; pairs in the order of the axes, the lower one first.
std::vector<Wall> box_plates(const Vec3& size_m);

/// Inner lengths of the box of one lane.
Vec3 box_size_m(const LaneRun& run, int lane);

/// Area of the plates across an axis.
double plate_area_m2(const Vec3& size_m, int axis);

/// Normal stress on the plates of an axis, mean of both over the last interval, compression positive.
double box_stress_Pa(const LaneRun& run, int lane, int axis);

/// Lets the upper plate of an axis hold a stress by servo (see hold_stress) from now on.
void hold_box_stress(LaneRun& run, int lane, int axis, double stress_Pa, double max_speed_m_per_s);

/// The force to hold follows the area of the plate: call once per interval.
void update_box_stress(LaneRun& run, int lane, int axis, double stress_Pa);

/// Volume of the voids over that of the grains.
double void_ratio(const LaneRun& run, int lane);

}  // namespace tilth
