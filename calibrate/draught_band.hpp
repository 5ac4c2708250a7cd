// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a field standard expects a sweep to pull: a plausibility check, never a target.
#pragma once

#include <optional>
#include <string>

#include "calibrate/soil_data.hpp"

namespace tilth {

enum class TextureClass { coarse, medium, fine };

const char* name_of(TextureClass texture);

/// The standard's words are "sandy", "loamy" and "high in clay"; our limits: coarse from 70 % of sand, fine from
/// 35 % of clay, else medium. Nothing where soil.json does not say both.
std::optional<TextureClass> texture_class(const SoilData& soil);

struct DraughtBand {
  double low_N = 0.0, middle_N = 0.0, high_N = 0.0;
};

/// ASABE D497, sweep plow, primary tillage:
///   D = F (A + B S + C S^2) W T,  A = 390, B = 19, C = 0, S in km/h, W in m, T in cm;  +- 45 %
///   F = 1.0 fine, 0.85 medium, 0.65 coarse
/// @source A, B, C as coded in github.com/simscape/Tractor-Simscape, commit 2ea4dc90, implement.ssc; F and the scatter
///         are those commonly quoted from the standard, not read in it
DraughtBand sweep_draught_band(TextureClass texture, double width_m, double depth_m, double speed_m_per_s);

/// "D497 expects 286 to 754 N (middle 520 N, coarse texture) ...; 305 N is inside it"
std::string draught_sentence(TextureClass texture, const DraughtBand& band, double draught_N);

}  // namespace tilth
