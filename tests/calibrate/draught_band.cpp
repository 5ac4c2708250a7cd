// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The D497 band: its numbers at one depth and speed, its growth, its classes.
#include "calibrate/draught_band.hpp"

#include <catch2/catch.hpp>

#include "calibrate/cli/soil_choice.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

TEST_CASE("D497: draught of a sweep plow at 10 cm and 3.2 km/h", "[calibrate][draught_band]") {
  // (390 + 19 * 3.2) * 10 cm = 4508 N per metre of width
  const double speed_m_per_s = 3.2 / 3.6;
  CHECK_THAT(sweep_draught_band(TextureClass::fine, 1.0, 0.10, speed_m_per_s).middle_N, WithinRel(4508.0, 1e-12));
  CHECK_THAT(sweep_draught_band(TextureClass::medium, 0.25, 0.10, speed_m_per_s).middle_N,
             WithinRel(0.85 * 0.25 * 4508.0, 1e-12));
  const DraughtBand coarse = sweep_draught_band(TextureClass::coarse, 0.25, 0.10, speed_m_per_s);
  CHECK_THAT(coarse.low_N, WithinRel(0.55 * coarse.middle_N, 1e-12));
  CHECK_THAT(coarse.high_N, WithinRel(1.45 * coarse.middle_N, 1e-12));
  // proportional to depth; with speed by (390 + 19 S)
  CHECK_THAT(sweep_draught_band(TextureClass::coarse, 0.25, 0.05, speed_m_per_s).middle_N,
             WithinRel(0.5 * coarse.middle_N, 1e-12));
  CHECK_THAT(sweep_draught_band(TextureClass::coarse, 0.25, 0.10, 2 * speed_m_per_s).middle_N / coarse.middle_N,
             WithinRel((390 + 38 * 3.2) / (390 + 19 * 3.2), 1e-12));
  CHECK_THAT(draught_sentence(TextureClass::coarse, coarse, 500.0), Contains("inside it"));
  CHECK_THAT(draught_sentence(TextureClass::coarse, coarse, 200.0), Contains("below it"));
  CHECK_THAT(draught_sentence(TextureClass::coarse, coarse, 3000.0), Contains("above it"));
}

TEST_CASE("D497: classes of the shipped soils", "[calibrate][draught_band]") {
  const auto of = [](const char* id) { return texture_class(load_soil(data_root() / "soils" / id)); };
  CHECK(of("coarse_sand") == TextureClass::coarse);
  CHECK(of("loamy_sand") == TextureClass::coarse);
  CHECK(of("sandy_loam") == TextureClass::medium);
  CHECK_FALSE(of("karlsruhe_fine_sand"));
}
