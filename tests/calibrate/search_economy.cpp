// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "calibrate/fit.hpp"
#include "calibrate/optimise_nlopt.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace tilth {
namespace {

using namespace tilth::test;

constexpr double packing_noise = 0.05;
constexpr double sigma = 0.05;

// Noise-free chi-square in units of what one simulation resolves.
double noise_free_chi_square(const std::vector<Target>& targets, const Eigen::VectorXd& values) {
  const Eigen::VectorXd features = soil_formula(values);
  double sum = 0.0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double residual = std::log(features[static_cast<Eigen::Index>(k)] / targets[k].value);
    sum += residual * residual / (sigma * sigma + packing_noise * packing_noise);
  }
  return sum;
}

double least_chi_square(const std::vector<Target>& targets) {
  const std::vector<Parameter> parameters = soil_parameters();
  Eigen::VectorXd truth(3);
  for (Eigen::Index j = 0; j < 3; ++j) {
    truth[j] = unit_from_physical(parameters[static_cast<std::size_t>(j)], soil_truth()[j]);
  }
  const auto objective = [&](const Eigen::VectorXd& unit) {
    return noise_free_chi_square(targets, physical_point(parameters, unit));
  };
  return minimise_with_nlopt(objective, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Ones(3), truth,
                             {NloptAlgorithm::sbplx, 2000, 1e-6, 1})
      .value;
}

TEST_CASE("Search: a fit of 100 simulations, error bars included, ends within the noise floor",
          "[calibrate][search]") {
  FitOptions options;
  options.max_simulations = 100;
  options.profiles = ProfileSource::none;
  const std::vector<Target> targets = soil_targets(sigma, 1);
  const Simulator simulator = simulator_of(soil_formula, packing_noise, 1);
  const FitSummary summary = fit(soil_parameters(), targets, simulator, nullptr, options);
  REQUIRE(summary.num_simulations <= 100);
  // 3, the number of free parameters: errors of the data and of one simulation put the truth itself
  // so far above the least, on average.
  CHECK(noise_free_chi_square(targets, summary.values()) < least_chi_square(targets) + 3.0);
}

}  // namespace
}  // namespace tilth
