// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "calibrate/fit.hpp"
#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

FitOptions options_without_noise() {
  FitOptions options;
  options.num_noise_seeds = 0;
  options.num_search_seeds = 1;
  return options;
}

FitSummary fit_soil(const Simulator& simulator) {
  return fit(soil_parameters(), soil_targets(0.05, 0), simulator, nullptr, options_without_noise());
}

void require_recovered(const FitSummary& summary) {
  REQUIRE(summary.is_usable());
  for (Eigen::Index i = 0; i < 3; ++i) {
    // 2 %: half a standard error; a local search that backs off ends a little earlier.
    REQUIRE_THAT(summary.values()[i], WithinRel(soil_truth()[i], 0.02));
  }
}

// One run in ten, chosen by the digits of its parameters.
bool unlucky(const Eigen::VectorXd& p) {
  std::uint64_t word = 0;
  for (const double value : p) word = scrambled(word ^ std::bit_cast<std::uint64_t>(value));
  return word % 10 == 0;
}

}  // namespace

TEST_CASE("Fit: one failed run in ten is recorded, left out, and does not move the answer",
          "[calibrate][fit]") {
  const FitSummary summary = fit_soil(failing(simulator_of(soil_formula), unlucky));
  require_recovered(summary);
  REQUIRE(summary.failures.size() > 3);
  for (const FailedRun& run : summary.failures) {
    REQUIRE(run.message == "the packing exploded");
    REQUIRE(unlucky(run.parameters));
    REQUIRE_FALSE(run.stage.empty());
  }
}

TEST_CASE("Fit: a region where the model fails is avoided", "[calibrate][fit]") {
  // A quarter of the cube, its edge 20 % away from the truth.
  const auto stiff = [](const Eigen::VectorXd& p) { return p[0] > 3e7; };
  const FitSummary summary = fit_soil(failing(simulator_of(soil_formula), stiff));
  require_recovered(summary);
  REQUIRE(summary.failures.size() > 3);
}

TEST_CASE("Fit: the search does not run again and again into a region known to fail",
          "[calibrate][fit]") {
  // A slab of a fifth of the cube with the best point in its middle.
  const auto near_best = [](const Eigen::VectorXd& p) {
    return std::abs(std::log(p[0] / soil_truth()[0])) < 0.5;
  };
  const FitSummary summary = fit_soil(failing(simulator_of(soil_formula), near_best));
  REQUIRE(summary.is_usable());
  for (const StageCount& stage : summary.stages) {
    // Of 18 runs 6 fail; without looking at the nearest known run 10 do.
    if (stage.stage == "search") REQUIRE(stage.num_failed <= 6);
  }
}

TEST_CASE("Fit: the optimum at the edge of a failing region is fitted with one-sided secants",
          "[calibrate][fit]") {
  const double edge = soil_truth()[0] * 1.005;
  const auto stiff = [edge](const Eigen::VectorXd& p) { return p[0] > edge && p[0] < 1.2 * edge; };
  require_recovered(fit_soil(failing(simulator_of(soil_formula), stiff)));
}

TEST_CASE("Fit: when more than 30 % of the design fails it ends and says why", "[calibrate][fit]") {
  const auto most = [](const Eigen::VectorXd& p) { return p[0] > 5e6; };
  const FitSummary summary = fit_soil(failing(simulator_of(soil_formula), most));
  REQUIRE(summary.termination == Termination::too_many_failures);
  REQUIRE_FALSE(summary.is_usable());
  REQUIRE_THAT(summary.message, Contains("30 %") && Contains("the packing exploded"));
  REQUIRE(summary.num_simulations == 33);  // the design, nothing after it
}

TEST_CASE("Fit: when every run fails the summary still stands", "[calibrate][fit]") {
  const auto always = [](const Eigen::VectorXd&) { return true; };
  FitOptions options = options_without_noise();
  for (const int num_design : {0, 32}) {
    options.num_design = num_design;
    const FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 0),
                                   failing(simulator_of(soil_formula), always), nullptr, options);
    REQUIRE_FALSE(summary.is_usable());
    REQUIRE(summary.termination ==
            (num_design == 0 ? Termination::no_convergence : Termination::too_many_failures));
    REQUIRE(summary.parameters.size() == 3);
    REQUIRE_THAT(summary.parameters[0].no_error_bar, Contains("no local search"));
  }
}

TEST_CASE("Fit: a feature that is not a number is a failed run, not a value", "[calibrate][fit]") {
  const auto holed = simulator_of([](const Eigen::VectorXd& p) {
    Eigen::VectorXd f = soil_formula(p);
    if (unlucky(p)) f[4] = std::numeric_limits<double>::quiet_NaN();
    return f;
  });
  const FitSummary summary = fit_soil(holed);
  require_recovered(summary);
  REQUIRE_THAT(summary.failures.front().message, Contains("feature_4") && Contains("not finite"));
}
