// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Dissimilarity, its interval and the scale limit against known truths.
#include "calibrate/scale_study.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;

namespace {

constexpr double radii_m[] = {0.008, 0.010, 0.014, 0.020};
constexpr Eigen::Index num_quantities = 12;

/// u = 0.1 (1 + slope (r - finest) d), d a direction of length |1|: the share is slope (r - finest) exactly.
/// Scatter: independent, and a common factor of the same size that moves all quantities of a packing.
std::vector<SizeAnswers> answers(double slope_per_m, double sd_m, int num_packings, std::uint64_t study) {
  std::vector<SizeAnswers> sizes;
  std::uint64_t stream = 1;
  for (const double r : radii_m) {
    SizeAnswers size{r, {}};
    for (int p = 0; p < num_packings; ++p, ++stream) {
      Eigen::VectorXd u(num_quantities);
      const double common = test::normal_number(stream, study, 99);
      for (Eigen::Index k = 0; k < num_quantities; ++k) {
        const double direction = k % 2 == 0 ? 1.0 : -1.0;
        const double own = test::normal_number(stream, study, static_cast<std::uint64_t>(k));
        u[k] = 0.1 * (1 + slope_per_m * (r - radii_m[0]) * direction) + sd_m * (own + common) / std::sqrt(2.0);
      }
      size.displacement_m.push_back(u);
    }
    sizes.push_back(size);
  }
  return sizes;
}

}  // namespace

TEST_CASE("Scale study: without scatter the shares and the limit are exact", "[calibrate][scale]") {
  std::vector<SizeAnswers> sizes = answers(25.0, 0.0, 2, 1);
  std::swap(sizes.front(), sizes.back());  // any order
  const ScaleStudy study = study_scale(sizes, 0.15);
  REQUIRE(study.sizes.size() == 4);
  for (const Dissimilarity& d : study.sizes) {
    CHECK_THAT(d.share, WithinAbs(25.0 * (d.radius_m - 0.008), 1e-12));
    CHECK_THAT(d.raw, WithinAbs(d.share, 1e-12));
  }
  CHECK(study.limit.verdict == ScaleVerdict::found);
  CHECK_THAT(study.limit.radius_m, WithinRel(0.008 + 0.15 / 25.0, 1e-12));
}

TEST_CASE("Scale study: scatter adds nothing to the share, and its intervals hold the truth",
          "[calibrate][scale]") {
  constexpr int num_studies = 2000;
  constexpr double slope_per_m = 20.0;  // shares of 0.04, 0.12 and 0.24
  double slope_squared = 0.0;
  int covers[4] = {}, limit_covers = 0, num_found = 0;
  for (int k = 0; k < num_studies; ++k) {
    const ScaleStudy study = study_scale(answers(slope_per_m, 0.01, 3, static_cast<std::uint64_t>(k)), 0.1);
    slope_squared += study.limit.slope_squared_per_m2 / num_studies;
    for (std::size_t i = 1; i < 4; ++i) {
      const Dissimilarity& d = study.sizes[i];
      const double truth = slope_per_m * (d.radius_m - radii_m[0]);
      covers[i] += d.lo95 <= truth && truth <= d.hi95;
    }
    const double truth_m = radii_m[0] + 0.1 / slope_per_m;
    limit_covers += study.limit.lo95_m <= truth_m && truth_m <= study.limit.hi95_m.value_or(1.0);
    num_found += study.limit.verdict == ScaleVerdict::found;
  }
  // Its own standard error over 2000 studies is 0.3 %.
  CHECK_THAT(slope_squared, WithinRel(slope_per_m * slope_per_m, 0.02));
  // 90 %: a common factor leaves fewer independent numbers than Student's t is told of.
  for (std::size_t i = 1; i < 4; ++i) {
    CAPTURE(i, covers[i]);
    CHECK(covers[i] > 0.90 * num_studies);
  }
  // A share below its scatter lies in [0, something] nearly always; the largest must be missed at times.
  CHECK(covers[3] < 0.99 * num_studies);
  CAPTURE(limit_covers);
  CHECK(limit_covers > 0.90 * num_studies);
  CHECK(limit_covers < 0.995 * num_studies);
  CHECK(num_found > 0.99 * num_studies);
}

TEST_CASE("Scale study: sizes that do not differ give no limit", "[calibrate][scale]") {
  constexpr int num_studies = 1000;
  int num_found = 0, num_within = 0, num_wrong = 0;
  for (int k = 0; k < num_studies; ++k) {
    num_found += study_scale(answers(0.0, 0.01, 3, static_cast<std::uint64_t>(k)), 0.15).limit.verdict ==
                 ScaleVerdict::found;
    num_within += study_scale(answers(0.0, 0.002, 3, static_cast<std::uint64_t>(k)), 0.15).limit.verdict ==
                  ScaleVerdict::all_within;
    // The coarsest is off by 18 %: to be within 15 % is wrong, whatever the scatter.
    num_wrong += study_scale(answers(15.0, 0.05, 3, static_cast<std::uint64_t>(k)), 0.15).limit.verdict ==
                 ScaleVerdict::all_within;
  }
  CAPTURE(num_found, num_within, num_wrong);
  CHECK(num_wrong < 0.05 * num_studies);
  CHECK(num_found < 0.06 * num_studies);
  CHECK(num_within > 0.9 * num_studies);
}

TEST_CASE("Scale study: drift is a ratio to the finest with the error of both", "[calibrate][scale]") {
  const double sizes_m[] = {0.02, 0.01};
  const std::vector<double> values[] = {{330.0, 300.0, 270.0}, {190.0, 210.0}};
  const std::vector<Drift> drift = drift_of(sizes_m, values);
  REQUIRE(drift.size() == 2);
  CHECK(drift[0].radius_m == 0.01);
  CHECK_THAT(drift[0].mean, WithinRel(200.0, 1e-12));
  CHECK_THAT(drift[1].over_finest, WithinRel(1.5, 1e-12));
  // relative errors: 30 / 300 / sqrt(3) and sqrt(200) / 200 / sqrt(2)
  CHECK_THAT(drift[1].over_finest_error, WithinRel(1.5 * std::hypot(0.1 / std::sqrt(3.0), 0.05), 1e-12));
}

TEST_CASE("Scale study: what cannot be compared is refused", "[calibrate][scale]") {
  std::vector<SizeAnswers> sizes = answers(0.0, 0.01, 2, 1);
  CHECK_THROWS_AS(study_scale(std::span(sizes).first(1), 0.1), std::invalid_argument);
  CHECK_THROWS_AS(study_scale(sizes, 0.0), std::invalid_argument);
  sizes[2].displacement_m.pop_back();
  CHECK_THROWS_AS(study_scale(sizes, 0.1), std::invalid_argument);
  sizes = answers(0.0, 0.01, 2, 1);
  sizes[1].radius_m = sizes[0].radius_m;
  CHECK_THROWS_AS(study_scale(sizes, 0.1), std::invalid_argument);
}
