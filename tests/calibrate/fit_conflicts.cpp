// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Targets that can be met alone but not together, and hold-outs with a simulator of their own.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "calibrate/fit.hpp"
#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinAbs;
using namespace tilth;

namespace {

const std::vector<Parameter> one_parameter = {test::linear_parameter("a", 0.0, 10.0, 2.0)};

Target target(const std::string& name, double value, bool holdout = false) {
  Target t;
  t.name = name;
  t.value = value;
  t.sigma = 1.0;
  t.holdout = holdout;
  t.statistic = name.substr(0, name.find('/'));
  return t;
}

/// Every feature is the parameter itself; those not asked for are NaN.
Simulator identity(std::vector<bool> asked) {
  return [asked](const Eigen::MatrixXd& p, std::span<const std::uint64_t>) {
    std::vector<Evaluation> runs;
    for (Eigen::Index m = 0; m < p.cols(); ++m) {
      Evaluation e;
      e.status = EvaluationStatus::completed;
      e.features = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(asked.size()), p(0, m));
      for (std::size_t k = 0; k < asked.size(); ++k)
        if (!asked[k])
          e.features[static_cast<Eigen::Index>(k)] = std::numeric_limits<double>::quiet_NaN();
      runs.push_back(e);
    }
    return runs;
  };
}

FitOptions noiseless() {
  FitOptions options;
  options.num_noise_seeds = 0;
  options.num_search_seeds = 1;
  return options;
}

}  // namespace

TEST_CASE("Fit: two values of one statistic that exclude each other are unreachable, with the number",
          "[calibrate][fit]") {
  const FitSummary s = fit(one_parameter, {target("modulus/soft", 1.0), target("modulus/stiff", 9.0)},
                           identity({true, true}), nullptr, noiseless());
  REQUIRE(s.conflicts.size() == 1);
  CHECK(s.conflicts.front().same_statistic);
  // half way both are 4 sigma off; 512 probes over 10 units leave 0.02
  CHECK_THAT(s.conflicts.front().misfit, WithinAbs(4.0, 0.02));
  for (const TargetResult& t : s.targets) {
    CHECK(t.reachability == Reachability::unreachable);
    CHECK_THAT(t.joint_misfit, WithinAbs(4.0, 0.02));
  }
  CHECK(s.has_unreachable_target());
}

TEST_CASE("Fit: values within two sigma of a common point are no conflict", "[calibrate][fit]") {
  const FitSummary s = fit(one_parameter, {target("modulus/soft", 4.0), target("modulus/stiff", 7.0)},
                           identity({true, true}), nullptr, noiseless());
  CHECK(s.conflicts.empty());
  CHECK_FALSE(s.has_unreachable_target());
}

TEST_CASE("Fit: hold-outs of their own simulator are never asked of the others, and get intervals",
          "[calibrate][fit]") {
  int num_holdout_runs = 0;
  const Simulator holdout = [&](const Eigen::MatrixXd& p, std::span<const std::uint64_t> seeds) {
    num_holdout_runs += static_cast<int>(p.cols());
    return identity({false, true})(p, seeds);
  };
  const std::vector<Target> targets = {target("x/fitted", 5.0), target("y/held", 6.0, true)};
  const FitSummary s = fit(one_parameter, targets, identity({true, false}), nullptr, noiseless(),
                           &holdout);
  REQUIRE(s.is_usable());
  REQUIRE(s.holdouts.size() == 1);
  CHECK_THAT(s.holdouts.front().simulated, WithinAbs(5.0, 0.05));
  // y = a, so its deviation is that of the parameter: sigma 1 of the one fitted target
  CHECK_THAT(s.holdouts.front().parameter_sd, WithinAbs(1.0, 0.01));
  CHECK_THAT(s.holdouts.front().residual, WithinAbs(-1.0 / std::sqrt(2.0), 0.05));
  CHECK(num_holdout_runs == noiseless().num_fresh_seeds + 2);  // the point itself is remembered
}
