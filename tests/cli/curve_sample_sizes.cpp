// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/curve_sample_sizes.hpp"

#include <catch2/catch.hpp>

#include "calibrate/cli/fit_output.hpp"
#include "calibrate/effective_sample_size.hpp"
#include "tests/calibrate/formula_models.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;

namespace {

/// 200 rows to a strain of 20 % at 100 kPa; the axial stress rises, the volume shrinks.
MeasuredCurve smooth_curve() {
  MeasuredCurve curve{"drained_triaxial", "lab", {}, {}, 1};
  for (int k = 0; k < 200; ++k) {
    const double strain = 0.001 * k;
    curve.rows.push_back({strain, 0.1 * strain, 1e5 * (1.0 + 10.0 * strain), 1e5});
  }
  return curve;
}

/// The same with another volumetric strain: that of `misfit(k)` more.
template <typename Misfit>
Curve with_volume_off_by(const Misfit& misfit) {
  Curve curve{"", {}, smooth_curve().rows};
  for (std::size_t k = 0; k < curve.rows.size(); ++k) curve.rows[k][1] += misfit(k);
  return curve;
}

double noise(std::size_t k) { return 1e-3 * test::normal_number(3, 1, k); }

}  // namespace

TEST_CASE("Curve sample sizes: a scattering misfit is worth all points, a smooth one few", "[cli][sample_size]") {
  const auto independent = curve_sample_sizes(smooth_curve(), with_volume_off_by(noise));
  REQUIRE(independent.size() == 2);
  CHECK(independent[0].curve == "drained_triaxial/stress_ratio/lab");
  CHECK(independent[0].effective == 1.0);  // no misfit at all: a constant
  CHECK(independent[1].curve == "drained_triaxial/volumetric_strain/lab");
  CHECK(independent[1].num_points == 200);
  // the autocorrelations of 200 points of noise are +-0.07 each, and few are summed
  CHECK_THAT(independent[1].effective, WithinRel(200.0, 0.3));

  const auto smooth = curve_sample_sizes(
      smooth_curve(), with_volume_off_by([](std::size_t k) { return 1e-3 * static_cast<double>(k); }));
  CHECK(smooth[1].effective < 5.0);
}

TEST_CASE("Curve sample sizes: compared at the measured strains both reach, between simulated rows", "[cli][sample_size]") {
  MeasuredCurve measured = smooth_curve();
  Curve coarse;  // every second row, to a strain of 10 %
  std::vector<double> misfit;
  for (std::size_t k = 0; k < measured.rows.size(); ++k) {
    if (k % 2 == 0 && k <= 100) coarse.rows.push_back(measured.rows[k]);
    if (k <= 100) misfit.push_back(-1e-3 * noise(k));
    measured.rows[k][1] += 1e-3 * noise(k);
  }
  const auto sizes = curve_sample_sizes(measured, coarse);
  CHECK(sizes[1].num_points == 101);
  // the volumetric strain is straight between the rows, so the noise comes back, 1e-6 with errors of 1e-17
  CHECK_THAT(sizes[1].effective, WithinRel(effective_sample_size(misfit), 1e-6));
  CHECK(curve_sample_sizes(measured, {}).empty());
}

TEST_CASE("Fit output: every measured curve of a test that was rerun has its sample sizes", "[cli][sample_size]") {
  const cli_test::TempFolder folder("curve_sample_sizes");
  SoilData soil = load_soil(soil_test::data_root() / "soils/karlsruhe_fine_sand");
  std::erase_if(soil.targets, [](const SoilTarget& t) { return t.condition_id != "TMD2"; });
  std::erase_if(soil.conditions, [](const TestCondition& c) { return c.id != "TMD2"; });
  FitSummary summary;
  for (const SoilParameter& p : soil.parameters) {
    FittedParameter value;
    value.value = p.nominal;
    summary.parameters.push_back(value);
  }
  PackingStore packings(default_packing_folder());
  const FitCurves out = write_curves_and_figures(soil, summary, Fidelity::preview, Fidelity::preview, 1,
                                                 RunContext{packings, 2}, folder.path());
  REQUIRE(out.sample_sizes.size() == 2);
  for (const CurveSampleSize& s : out.sample_sizes) {
    CHECK(s.curve.ends_with("/TMD2"));
    CHECK(s.num_points > 100);
    // both curves are smooth: their misfit is worth a handful of readings
    CHECK(s.effective >= 1.0);
    CHECK(s.effective < 0.2 * static_cast<double>(s.num_points));
  }
}
