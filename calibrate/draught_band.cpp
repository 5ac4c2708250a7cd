// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/draught_band.hpp"

#include <fmt/format.h>

namespace tilth {
namespace {

constexpr double scatter = 0.45;

double soil_factor(TextureClass texture) {
  switch (texture) {
    case TextureClass::coarse: return 0.65;
    case TextureClass::medium: return 0.85;
    case TextureClass::fine: return 1.0;
  }
  return 0.0;
}

/// In one number, or in the two of the Danish classification.
std::optional<double> sand_fraction(const SoilData& soil) {
  if (const auto whole = state_value(soil, "sand_50_2000um_fraction")) return whole;
  const auto fine = state_value(soil, "fine_sand_20_200um_fraction");
  const auto coarse = state_value(soil, "coarse_sand_200_2000um_fraction");
  return fine && coarse ? std::optional<double>(*fine + *coarse) : std::nullopt;
}

}  // namespace

const char* name_of(TextureClass texture) {
  switch (texture) {
    case TextureClass::coarse: return "coarse";
    case TextureClass::medium: return "medium";
    case TextureClass::fine: return "fine";
  }
  return "";
}

std::optional<TextureClass> texture_class(const SoilData& soil) {
  const auto clay = state_value(soil, "clay_fraction");
  const auto sand = sand_fraction(soil);
  if (!clay || !sand) return std::nullopt;
  return *clay >= 0.35 ? TextureClass::fine : *sand >= 0.70 ? TextureClass::coarse : TextureClass::medium;
}

DraughtBand sweep_draught_band(TextureClass texture, double width_m, double depth_m, double speed_m_per_s) {
  const double speed_km_per_h = 3.6 * speed_m_per_s, depth_cm = 100 * depth_m;
  const double middle_N = soil_factor(texture) * (390 + 19 * speed_km_per_h) * width_m * depth_cm;
  return {(1 - scatter) * middle_N, middle_N, (1 + scatter) * middle_N};
}

std::string draught_sentence(TextureClass texture, const DraughtBand& band, double draught_N) {
  const char* place = draught_N < band.low_N ? "below it" : draught_N > band.high_N ? "above it" : "inside it";
  return fmt::format("ASABE D497 (sweep plow, {} texture) expects {:.0f} to {:.0f} N, middle {:.0f} N: {:.0f} N is {}; a "
                     "plausibility check, not a target",
                     name_of(texture), band.low_N, band.high_N, band.middle_N, draught_N, place);
}

}  // namespace tilth
