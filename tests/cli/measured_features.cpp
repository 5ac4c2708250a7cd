// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The shipped targets of the Karlsruhe sand are what `calibrate features` reads off its curves.
#include "calibrate/cli/measured_features.hpp"

#include <catch2/catch.hpp>

#include "calibrate/cli/dem_problem.hpp"
#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using Catch::Matchers::Contains;

namespace {

SoilData sand() { return load_soil(soil_test::data_root() / "soils/karlsruhe_fine_sand"); }

const std::vector<std::string> fitted = {"TMD2", "TMD5", "TMD12", "TMD15", "TMD22", "TMD24"};

}  // namespace

TEST_CASE("Features: the shipped rows of the Karlsruhe sand are those of its curves",
          "[cli][features]") {
  const SoilData soil = sand();
  const std::string source = soil.targets.front().origin.source;
  CHECK(measurements_csv(features_of_curves(soil, fitted, source)) ==
        soil_test::read_text(soil.folder / "measurements.csv"));
}

TEST_CASE("Features: each triaxial test is a state of the series once, however many targets it has",
          "[cli][features]") {
  const SoilData soil = sand();
  for (const auto& [scope, num_states] :
       {std::pair{TargetScope::fitted, 6U}, {TargetScope::holdouts, 12U}, {TargetScope::all, 18U}}) {
    const std::vector<PlannedTest> tests = plan_tests(soil, Fidelity::search, scope);
    REQUIRE(tests.size() == 1);
    const auto& series = std::get<DrainedTriaxialConfig>(tests.front().config);
    CHECK(series.cell_pressure_Pa.size() == num_states);
    CHECK(series.relative_density.size() == num_states);
  }
}

TEST_CASE("Features: six tests are fitted, twelve held out, all measured", "[cli][features]") {
  const SoilData soil = sand();
  for (const SoilTarget& t : soil.targets) {
    CHECK(t.origin.provenance == Provenance::measured);
    CHECK(t.holdout == (std::ranges::find(fitted, t.condition_id) == fitted.end()));
  }
  CHECK(measured_share(soil.targets) == 1.0);
}

TEST_CASE("Features: an unknown condition and too few curves are said", "[cli][features]") {
  SoilData soil = sand();
  CHECK_THROWS_WITH(features_of_curves(soil, {"TMD3"}, "x"), Contains("TMD3"));
  soil.curves.resize(5);
  CHECK_THROWS_WITH(features_of_curves(soil, {}, "x"), Contains("at least 8"));
}
