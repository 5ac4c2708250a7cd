// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Features of triaxial curves whose answers are known.
#include "experiments/triaxial_features.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double cell_Pa = 100e3;

/// 201 rows to 20 %: stress ratio and volumetric strain as given functions of the strain.
template <class Ratio, class Volume>
Curve curve_of(Ratio ratio, Volume volume) {
  Curve curve{"synthetic", triaxial_columns, {}};
  for (int k = 0; k <= 200; ++k) {
    const double x = 1e-3 * k;
    const double eta = ratio(x);
    curve.rows.push_back({x, volume(x), cell_Pa * (1 + eta / (1 - eta / 3)), cell_Pa});
  }
  return curve;
}

double feature(const Curve& curve, const std::string& name) {
  ExperimentResult r;
  r.features = triaxial_features(curve);
  return r.feature(name);
}

}  // namespace

TEST_CASE("Triaxial features: a straight start, a parabolic peak and a straight dilation are read off exactly",
          "[experiments][triaxial]") {
  // eta = 1.5 - 40 (x - 0.08)^2 for x > 0.005 and a straight q before it; volume -0.4 (x - 0.02).
  const auto ratio = [](double x) {
    const double at = 1.5 - 40 * std::pow(0.005 - 0.08, 2);
    if (x > 0.005) return 1.5 - 40 * (x - 0.08) * (x - 0.08);
    const double q = x / 0.005 * at / (1 - at / 3);
    return q / (1 + q / 3);
  };
  const Curve curve = curve_of(ratio, [](double x) { return -0.4 * (x - 0.02); });
  const double at = 1.5 - 40 * 0.075 * 0.075;
  CHECK_THAT(feature(curve, "initial_modulus_Pa"),
             WithinRel(cell_Pa * at / (1 - at / 3) / 0.005, 1e-9));
  // mean of 40 x^2 over eleven rows 1e-3 apart: 40 * 1e-6 * 10
  CHECK_THAT(feature(curve, "peak_stress_ratio"), WithinAbs(1.5 - 4e-4, 1e-9));
  CHECK_THAT(feature(curve, "strain_at_peak"), WithinAbs(0.08, 1e-12));
  CHECK_THAT(feature(curve, "dilation_rate"), WithinAbs(0.4, 1e-9));
  CHECK_THAT(feature(curve, "final_volumetric_strain"), WithinAbs(-0.072, 1e-12));
  double end = 0;
  for (int k = 180; k <= 200; ++k) end += ratio(1e-3 * k) / 21;
  CHECK_THAT(feature(curve, "end_stress_ratio"), WithinAbs(end, 1e-9));
}

TEST_CASE("Triaxial features: the modulus is counted from the first row's own stress",
          "[experiments][triaxial]") {
  Curve curve = curve_of([](double x) { return 10 * x; }, [](double) { return 0.0; });
  const double before_Pa = feature(curve, "initial_modulus_Pa");
  curve.rows.front()[2] += 5e3;
  CHECK_THAT(feature(curve, "initial_modulus_Pa"), WithinRel(before_Pa - 5e3 / 0.005, 1e-9));
}

TEST_CASE("Triaxial features: a curve that ends before 4 % has none", "[experiments][triaxial]") {
  Curve curve = curve_of([](double x) { return 10 * x; }, [](double) { return 0.0; });
  curve.rows.resize(40);
  CHECK(triaxial_features(curve).empty());
}
