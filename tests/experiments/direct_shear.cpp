// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The shear box: its servo, its strength against friction and bonds, and its failure line.
#include <cmath>

#include "experiments/curve_features.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

std::vector<ExperimentResult> shear(const std::vector<SoilMaterial>& soils,
                                    const DirectShearConfig& config) {
  const std::vector<ExperimentResult> results = run_direct_shear(soils, config, packings());
  for (const ExperimentResult& r : results) {
    INFO(r.message);
    REQUIRE(r.status == RunStatus::completed);
  }
  return results;
}

}  // namespace

TEST_CASE("Direct shear: the servo holds the normal stress on stiff and on soft soil",
          "[experiments][shear]") {
  // A proportional servo without integral let a dilating stiff specimen reach 47 kPa instead of 10.
  DirectShearConfig config = small_shear(1e-4);
  config.num_particles = 300;
  config.normal_stress_Pa = {10e3, 40e3};
  std::vector<SoilMaterial> soils = {bonded_soil(20e6), bonded_soil(2e6)};
  soils[0].bond.tensile_strength_Pa = soils[0].bond.cohesion_Pa = 10e3;
  for (const ExperimentResult& r : shear(soils, config))
    for (std::size_t k = 0; k < r.curves.size(); ++k) {
      const Curve& curve = r.curves[k];
      const std::size_t column = column_of(curve, "normal_stress_Pa");
      const double target_Pa = config.normal_stress_Pa[k];
      double worst = 0;
      for (const auto& row : curve.rows)
        worst = std::max(worst, std::abs(row[column] / target_Pa - 1));
      const double mean_Pa = mean_of(curve, column, 0, curve.rows.size());
      INFO(curve.name << ": mean " << mean_Pa << " Pa, worst off by " << 100 * worst << " %");
      // The servo holds the top plate; the reading is the mean of top and bottom, which the rims of
      // the half boxes set apart by a few per cent in a specimen of this size.
      REQUIRE_THAT(mean_Pa, WithinRel(target_Pa, 0.03));
      REQUIRE(worst < 0.10);
    }
}

TEST_CASE("Direct shear: the friction angle of loose grains grows with their friction",
          "[experiments][shear]") {
  DirectShearConfig config = small_shear(4e-4);
  config.num_particles = 300;
  config.max_shear_strain = 0.2;
  config.porosity = 0.45;
  config.bond_gap_over_radius = -1;
  std::vector<SoilMaterial> soils(4, bonded_soil());
  const double friction[] = {0.0, 0.2, 0.5, 1.0};
  for (std::size_t k = 0; k < 4; ++k) soils[k].friction = friction[k];
  const std::vector<ExperimentResult> results = shear(soils, config);
  for (std::size_t k = 1; k < 4; ++k)
    REQUIRE(results[k].feature("friction_angle_rad") >
            results[k - 1].feature("friction_angle_rad"));
  // 3e3: residuals of 300 grains scatter; 5 to 25 kPa of shear stress stand behind these lines. The
  // box must travel well past the peak (10 % of its length here) or the line is one of unfinished
  // tests, with 8 kPa of cohesion that is not there.
  for (const ExperimentResult& r : results)
    REQUIRE(std::abs(r.feature("residual_cohesion_Pa")) < 3e3);
}

TEST_CASE("Direct shear: cohesion grows with bond strength", "[experiments][shear]") {
  DirectShearConfig config = small_shear(4e-4);
  config.num_particles = 300;
  config.max_shear_strain = 0.12;
  std::vector<SoilMaterial> soils(3, bonded_soil());
  const double strength_Pa[] = {5e3, 10e3, 20e3};
  for (std::size_t k = 0; k < 3; ++k)
    soils[k].bond.tensile_strength_Pa = soils[k].bond.cohesion_Pa = strength_Pa[k];
  const std::vector<ExperimentResult> results = shear(soils, config);
  for (std::size_t k = 1; k < 3; ++k)
    REQUIRE(results[k].feature("cohesion_Pa") > 1.3 * results[k - 1].feature("cohesion_Pa"));
}

TEST_CASE("Direct shear: the failure line passes the peaks, and one normal stress gives none",
          "[experiments][shear]") {
  DirectShearConfig config = small_shear();
  config.normal_stress_Pa = {10e3, 40e3};
  const ExperimentResult two = shear({bonded_soil()}, config).front();
  // Two points: the line passes both, up to rounding of the fit.
  for (const double p : config.normal_stress_Pa) {
    const double line_Pa =
        two.feature("cohesion_Pa") + p * std::tan(two.feature("friction_angle_rad"));
    const std::string name =
        p == 10e3 ? "peak_shear_stress_Pa@10000" : "peak_shear_stress_Pa@40000";
    REQUIRE_THAT(two.feature(name), WithinRel(line_Pa, 1e-9));
  }
  config.normal_stress_Pa = {40e3};
  const ExperimentResult one = shear({bonded_soil()}, config).front();
  REQUIRE(std::isnan(one.feature("cohesion_Pa")));
  REQUIRE(one.feature("peak_shear_stress_Pa@40000") == two.feature("peak_shear_stress_Pa@40000"));
}

TEST_CASE("Direct shear: a block cut at an angle is as strong as one cut upright",
          "[experiments][shear]") {
  // Packings have no direction of their own. 0.15: the peak of one packing of 150 grains varies by
  // some 8 %, a mean of three by 5 %, a quotient of two such means by 7 %, twice that.
  DirectShearConfig config = small_shear(8e-4);
  config.max_shear_strain = 0.06;
  config.normal_stress_Pa = {20e3};
  const auto mean_peak_Pa = [&](double angle_rad) {
    double sum = 0;
    for (const std::uint64_t seed : {1, 2, 3}) {
      config.packing_seed = seed;
      config.cut_angle_rad = angle_rad;
      sum += shear({bonded_soil()}, config).front().feature("peak_shear_stress_Pa@20000");
    }
    return sum / 3;
  };
  const double upright_Pa = mean_peak_Pa(1e-3);
  REQUIRE_THAT(mean_peak_Pa(0.785), WithinRel(upright_Pa, 0.15));
  REQUIRE_THAT(mean_peak_Pa(0), WithinRel(upright_Pa, 0.15));
}
