// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "calibrate/parallel.hpp"
#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

FitOptions small_options() {
  FitOptions options;
  options.num_design = 16;
  options.num_rounds = 1;
  options.round_size = 4;
  options.num_starts = 2;
  return options;
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

}  // namespace

TEST_CASE("Fit: before it runs a summary says that it has not", "[calibrate][fit]") {
  const FitSummary summary;
  REQUIRE(summary.brief_report() == "fit() was not called");
  REQUIRE_FALSE(summary.is_usable());
}

TEST_CASE("Fit: exact data of a noise-free formula give back the parameters", "[calibrate][fit]") {
  const FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 0),
                                 simulator_of(soil_formula), nullptr, small_options());
  REQUIRE(summary.termination == Termination::converged);
  REQUIRE(summary.is_usable());
  for (Eigen::Index i = 0; i < 3; ++i) {
    // chi_square_tolerance 0.01 is a tenth of a standard error at most; here sigma is 5 %.
    REQUIRE_THAT(summary.values()[i], WithinRel(soil_truth()[i], 5e-3));
  }
  REQUIRE(summary.chi_square < 0.01);
  REQUIRE(summary.chi_square_start > 100.0);
  REQUIRE(summary.num_starts_at_best == summary.num_starts);
  for (const TargetResult& target : summary.targets) {
    REQUIRE(target.reachability == Reachability::reachable);
  }
  REQUIRE_THAT(summary.brief_report(), Contains("converged"));
}

TEST_CASE("Fit: of a linear model the covariance is the closed form", "[calibrate][fit]") {
  Eigen::MatrixXd a(4, 2);
  a << 1.0, 2.0, 3.0, -1.0, 0.5, 0.5, 2.0, 2.0;
  const Eigen::Vector2d truth(3.0, 4.0);
  const double sigma = 0.1;
  std::vector<Target> targets;
  for (int k = 0; k < 4; ++k) {
    Target t;
    t.name = "y" + std::to_string(k);
    t.value = a.row(k).dot(truth) + sigma * normal_number(1, 1, static_cast<std::uint64_t>(k));
    t.sigma = sigma;
    targets.push_back(t);
  }
  const std::vector<Parameter> parameters = {linear_parameter("p", 0.0, 10.0, 5.0),
                                             linear_parameter("q", 0.0, 10.0, 5.0)};
  const auto simulator =
      simulator_of([a](const Eigen::VectorXd& p) -> Eigen::VectorXd { return a * p; });
  const FitSummary summary = fit(parameters, targets, simulator, nullptr, small_options());

  const Eigen::MatrixXd exact = sigma * sigma * (a.transpose() * a).inverse();
  // 1e-9: central secants of a linear function are exact to rounding / step.
  REQUIRE((summary.covariance - exact).norm() < 1e-9 * exact.norm());
  Eigen::VectorXd y(4);
  for (int k = 0; k < 4; ++k) y[k] = targets[static_cast<std::size_t>(k)].value;
  const Eigen::VectorXd best = (a.transpose() * a).inverse() * a.transpose() * y;
  const double half_width = 1.959963984540054 * std::sqrt(exact(0, 0));
  // 1e-4 of a range of 10: one damped step from a point that is already near.
  REQUIRE_THAT(summary.values()[0], WithinAbs(best[0], 1e-3));
  REQUIRE_THAT(summary.parameters[0].hi95 - summary.parameters[0].value,
               WithinRel(half_width, 1e-9));
  REQUIRE_THAT(summary.correlation(0, 1),
               WithinRel(exact(0, 1) / std::sqrt(exact(0, 0) * exact(1, 1)), 1e-8));
}

TEST_CASE("Fit: hold-out values do not move a bit of the fit", "[calibrate][fit]") {
  std::vector<Target> targets = soil_targets(0.05, 3);
  targets[5].holdout = true;
  const auto run = [&] {
    return fit(soil_parameters(), targets, simulator_of(soil_formula, 0.03), nullptr,
               small_options());
  };
  const FitSummary first = run();
  targets[5].value *= 7.0;
  targets[5].sigma *= 0.1;
  const FitSummary second = run();
  REQUIRE(same_bits(first.values(), second.values()));
  REQUIRE(same_bits(first.covariance, second.covariance));
  REQUIRE(same_bits(first.seed_covariance, second.seed_covariance));
  REQUIRE(first.chi_square == second.chi_square);
  REQUIRE(first.num_simulations == second.num_simulations);
  REQUIRE(first.targets.size() == 5);
  REQUIRE(first.holdouts.size() == 1);
  REQUIRE_FALSE(first.holdout_failed());
  REQUIRE(second.holdout_failed());
  // The hold-out is predicted with the uncertainty of the parameters in it.
  REQUIRE(first.holdouts[0].sigma_total > first.holdouts[0].parameter_sd);
}

TEST_CASE("Fit: the same seed gives the same bits at one and two threads", "[calibrate][fit]") {
  const auto threaded = [](int num_threads) -> Simulator {
    return [num_threads](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
      std::vector<Evaluation> runs(static_cast<std::size_t>(parameters.cols()));
      parallel_for_each_index(runs.size(), num_threads, [&](std::size_t i) {
        runs[i] =
            simulator_of(soil_formula, 0.05)(parameters.col(static_cast<Eigen::Index>(i)),
                                              seeds.subspan(i, 1))
                .front();
      });
      return runs;
    };
  };
  FitOptions options = small_options();
  const auto run = [&](int num_threads) {
    return fit(soil_parameters(), soil_targets(0.05, 2), threaded(num_threads), nullptr, options);
  };
  const FitSummary one = run(1);
  const FitSummary two = run(2);
  REQUIRE(same_bits(one.values(), two.values()));
  REQUIRE(same_bits(one.covariance, two.covariance));
  REQUIRE(one.num_simulations == two.num_simulations);
  options.seed = 50;
  REQUIRE_FALSE(same_bits(one.values(), run(1).values()));
}

TEST_CASE("Fit: more free parameters than independent observations are refused by name",
          "[calibrate][fit]") {
  std::vector<Target> targets = soil_targets(0.05, 0);
  for (Target& target : targets) target.observation_group = "one curve";
  targets[0].observation_group = "stiffness";
  FitOptions options = small_options();
  const auto run = [&](const std::vector<Parameter>& parameters) {
    return fit(parameters, targets, simulator_of(soil_formula), nullptr, options);
  };
  const FitSummary refused = run(soil_parameters());
  REQUIRE(refused.termination == Termination::under_determined);
  REQUIRE(refused.num_simulations == 0);
  REQUIRE_THAT(refused.message, Contains("modulus_Pa, strength_Pa, friction") && Contains("2"));

  options.force = true;
  REQUIRE(run(soil_parameters()).is_usable());

  options.force = false;
  std::vector<Parameter> with_prior = soil_parameters();
  with_prior[2].prior_mean = std::log(0.45);
  with_prior[2].prior_sigma = 0.2;
  REQUIRE(run(with_prior).termination == Termination::converged);
}

TEST_CASE("Fit: a combination the data do not fix gets words instead of an error bar",
          "[calibrate][fit]") {
  // Only the product modulus * strength and the friction show.
  const auto blind = simulator_of([](const Eigen::VectorXd& p) {
    Eigen::VectorXd f(3);
    f << p[0] * p[1], std::sqrt(p[0] * p[1]), p[2];
    return f;
  });
  const Eigen::VectorXd truth = soil_truth();
  const std::vector<Target> targets = {log_target("product", truth[0] * truth[1], 0.05),
                                       log_target("root", std::sqrt(truth[0] * truth[1]), 0.05),
                                       log_target("mu", truth[2], 0.05)};
  const FitSummary summary = fit(soil_parameters(), targets, blind, nullptr, small_options());
  REQUIRE(summary.null_directions.size() == 1);
  REQUIRE_THAT(summary.null_directions[0],
               Contains("modulus_Pa / strength_Pa") || Contains("strength_Pa / modulus_Pa"));
  // ln modulus + ln strength is fixed: a modulus 8 % above its lower bound needs a strength above 1e5.
  REQUIRE(summary.parameters[0].verdict == ParameterVerdict::bound_limited);
  REQUIRE(summary.parameters[0].limited_by == "strength_Pa");
  REQUIRE_THAT(summary.parameters[0].no_error_bar, Contains("do not fix"));
  REQUIRE(std::isnan(summary.parameters[0].lo95));
  REQUIRE(summary.parameters[2].verdict == ParameterVerdict::identified);
  // ln mu is measured directly: its standard error is sigma; 1e-6: secants of ln mu are exact.
  REQUIRE_THAT(summary.parameters[2].standard_error, WithinRel(0.05, 1e-6));
}

TEST_CASE("Fit: a prior on one factor fixes the other", "[calibrate][fit]") {
  const auto product = simulator_of(
      [](const Eigen::VectorXd& p) { return Eigen::VectorXd::Constant(1, p[0] * p[1]); });
  std::vector<Parameter> parameters = {log_parameter("a", 0.1, 10.0, 1.0),
                                       log_parameter("b", 0.1, 10.0, 1.0)};
  parameters[0].prior_mean = std::log(2.0);
  parameters[0].prior_sigma = 0.1;
  const FitSummary summary =
      fit(parameters, {log_target("ab", 6.0, 0.05)}, product, nullptr, small_options());
  // chi-square 0 is reached: a = 2, b = 3; 1 %: chi_square_tolerance is 0.1 standard errors.
  REQUIRE_THAT(summary.values()[0], WithinRel(2.0, 0.01));
  REQUIRE_THAT(summary.values()[1], WithinRel(3.0, 0.015));
  // var ln b = 0.05^2 + 0.1^2; 1e-6: the model is linear in the logarithms.
  REQUIRE_THAT(summary.parameters[1].standard_error, WithinRel(std::sqrt(0.0125), 1e-6));
}

TEST_CASE("Fit: a value cut off by its bound is flagged and its interval stays inside",
          "[calibrate][fit]") {
  std::vector<Parameter> parameters = soil_parameters();
  parameters[2].upper = 0.4;  // the truth is 0.45
  parameters[2].start = 0.2;
  const FitSummary summary =
      fit(parameters, soil_targets(0.05, 0), simulator_of(soil_formula), nullptr, small_options());
  REQUIRE(summary.parameters[2].value == 0.4);
  REQUIRE(summary.parameters[2].hi95 == 0.4);
  REQUIRE(summary.parameters[2].verdict == ParameterVerdict::one_sided);
  REQUIRE(summary.parameters[0].verdict == ParameterVerdict::identified);
}

TEST_CASE("Fit: a target outside everything the model can do is called unreachable",
          "[calibrate][fit]") {
  std::vector<Target> targets = soil_targets(0.05, 0);
  targets[3].value = 5.0;  // 0.2 + friction <= 1.7
  const FitSummary summary =
      fit(soil_parameters(), targets, simulator_of(soil_formula), nullptr, small_options());
  REQUIRE(summary.targets[3].reachability == Reachability::unreachable);
  REQUIRE(summary.targets[3].reach_gap > 2.0);
  REQUIRE(summary.targets[0].reachability == Reachability::reachable);
  REQUIRE(summary.has_unreachable_target());
}

TEST_CASE("Fit: a model that does not fit is called that, one that does is not", "[calibrate][fit]") {
  const auto misfits = [](const std::vector<Target>& targets) {
    const FitSummary summary =
        fit(soil_parameters(), targets, simulator_of(soil_formula), nullptr, small_options());
    return std::ranges::count_if(summary.warnings, [](const std::string& w) {
      return w.starts_with("the model does not fit: reduced chi-square");
    });
  };
  std::vector<Target> targets = soil_targets(0.05, 3);
  CHECK(misfits(targets) == 0);
  targets[3].value = 5.0;  // 0.2 + friction <= 1.7
  CHECK(misfits(targets) == 1);
}

TEST_CASE("Fit: gates are judged before the search and name what is wrong", "[calibrate][fit]") {
  std::vector<Target> targets = soil_targets(0.05, 0);
  targets[3].value = 5.0;  // 0.2 + friction <= 1.7
  targets[1].sigma = 0.01;
  FitOptions options = small_options();
  std::string stage;
  std::vector<Gate> told;
  options.progress = [&](const Progress& p) { stage = p.stage; };
  options.report_gate = [&](const Gate& gate) {
    CHECK(stage == "noise floor");
    told.push_back(gate);
  };
  const FitSummary summary =
      fit(soil_parameters(), targets, simulator_of(soil_formula, 0.03), nullptr, options);
  REQUIRE(summary.gates.size() == 3);
  REQUIRE(told.size() == 3);
  CHECK(summary.gates[0].passed);
  CHECK_THAT(summary.gates[0].words, Contains("scatters more than the measurement in 1 of 6") &&
                                         Contains(targets[1].name));
  CHECK_FALSE(summary.gates[1].passed);
  CHECK_THAT(summary.gates[1].words, Contains("1 of 6") && Contains(targets[3].name) && Contains("sigma"));
  CHECK(summary.gates[2].passed);
  CHECK_THAT(summary.gates[2].words, Contains("3 free parameters"));
}

TEST_CASE("Fit: the bias of the search model is found, removed and reported with its error",
          "[calibrate][fit]") {
  const double factor = 1.25;
  const auto slow = simulator_of(
      [factor](const Eigen::VectorXd& p) -> Eigen::VectorXd { return factor * soil_formula(p); },
      0.02, 11);
  std::vector<Target> targets = soil_targets(0.05, 0);
  for (Target& target : targets) target.value *= factor;  // the slow model is the true one
  const Simulator confirm = slow;
  const FitSummary summary = fit(soil_parameters(), targets, simulator_of(soil_formula, 0.02, 12),
                                 &confirm, small_options());
  REQUIRE(summary.num_bias_rounds >= 1);
  for (const TargetResult& target : summary.targets) {
    // 4 standard errors in each of six targets: one false alarm in 2600.
    REQUIRE_THAT(target.bias, WithinAbs(std::log(factor), 4.0 * target.bias_error));
    REQUIRE(target.bias_error < 0.03);  // sqrt(0.02^2 / 4 + 0.02^2 / 3) = 0.015, moderated
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double truth = soil_truth()[static_cast<Eigen::Index>(i)];
    const double error = std::log(summary.parameters[i].value / truth);
    REQUIRE(std::abs(error) < 3.0 * summary.parameters[i].standard_error);
  }
  REQUIRE(summary.chi_square_fresh < 12.6);  // 95 % point of chi-square with 6; see the seed noise
}

TEST_CASE("Fit: noise is measured in units of the transformed target and moderated",
          "[calibrate][fit]") {
  FitOptions options = small_options();
  options.num_noise_seeds = 200;
  const FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 0),
                                 simulator_of(soil_formula, 0.08), nullptr, options);
  REQUIRE(summary.num_noise_seeds == 200);
  for (const TargetResult& target : summary.targets) {
    // Standard deviation of 200 normal numbers: relative error 1 / sqrt(398) = 5 %, four of them.
    REQUIRE_THAT(target.seed_sd, WithinRel(0.08, 0.2));
  }
}

TEST_CASE("Fit: the budget ends it with what is known, and is never exceeded", "[calibrate][fit]") {
  FitOptions options = small_options();
  for (const std::size_t budget : {std::size_t{5}, std::size_t{30}, std::size_t{70}}) {
    options.max_simulations = budget;
    const FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 1),
                                   simulator_of(soil_formula, 0.05), nullptr, options);
    REQUIRE(summary.termination == Termination::budget_spent);
    REQUIRE(summary.num_simulations <= budget);
    REQUIRE(summary.parameters.size() == 3);
    REQUIRE(summary.num_fresh_seeds > 0);  // reserved
    REQUIRE(summary.values().allFinite());
  }
}

TEST_CASE("Fit: stopped before its local search it is no worse than its start, by the final sigmas",
          "[calibrate][fit]") {
  std::vector<Parameter> at_the_truth = soil_parameters();
  for (std::size_t k = 0; k < 3; ++k) at_the_truth[k].start = soil_truth()[static_cast<Eigen::Index>(k)];
  for (const std::string last_stage : {"noise floor", "search"}) {
    FitOptions options = small_options();
    bool stop = false;
    options.progress = [&](const Progress& p) { stop = p.stage == last_stage; };
    options.should_stop = [&] { return stop; };
    const FitSummary summary = fit(at_the_truth, soil_targets(0.05, 1),
                                   simulator_of(soil_formula, 0.05), nullptr, options);
    CHECK(summary.termination == Termination::stopped);
    CHECK(summary.starts.empty());
    CHECK(summary.num_noise_seeds > 1);
    CHECK(summary.chi_square <= summary.chi_square_start);
  }
}

TEST_CASE("Fit: a stop at any moment leaves a valid summary", "[calibrate][fit]") {
  for (const int batches : {0, 1, 2, 4, 6, 8}) {
    FitOptions options = small_options();
    int done = 0;
    std::size_t last_progress = 0;
    options.should_stop = [&] { return done >= batches; };
    options.progress = [&](const Progress& progress) {
      ++done;
      REQUIRE(progress.num_done > last_progress);
      REQUIRE(progress.num_expected > 0);
      last_progress = progress.num_done;
    };
    const FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 1),
                                   simulator_of(soil_formula, 0.05), nullptr, options);
    REQUIRE(summary.termination == Termination::stopped);
    REQUIRE(summary.parameters.size() == 3);
    REQUIRE(summary.values().allFinite());
    REQUIRE(done == batches);
    for (const FittedParameter& p : summary.parameters) {
      REQUIRE(std::isfinite(p.standard_error) == p.no_error_bar.empty());
    }
  }
}

TEST_CASE("Fit: everything wrong with its arguments is listed, nothing is run",
          "[calibrate][fit]") {
  std::vector<Parameter> parameters = soil_parameters();
  parameters[0].lower = 1e9;
  std::vector<Target> targets = soil_targets(0.05, 0);
  targets[1].sigma = -1.0;
  FitOptions options;
  options.num_starts = 0;
  const FitSummary summary = fit(parameters, targets, simulator_of(soil_formula), nullptr, options);
  REQUIRE(summary.termination == Termination::bad_input);
  REQUIRE_THAT(summary.message,
               Contains("modulus_Pa") && Contains("sigma = -1") && Contains("num_starts"));
}

TEST_CASE("Fit: the quick preset recovers the parameters with fewer runs", "[calibrate][fit]") {
  const auto run = [](const FitOptions& options) {
    return fit(soil_parameters(), soil_targets(0.05, 0), simulator_of(soil_formula, 0.02), nullptr,
               options);
  };
  REQUIRE(problems(quick_fit_options()).empty());
  const FitSummary quick = run(quick_fit_options());
  REQUIRE(quick.is_usable());
  REQUIRE(quick.num_simulations < run(FitOptions{}).num_simulations / 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    // Three standard errors of about 6 %.
    REQUIRE_THAT(quick.values()[i], WithinRel(soil_truth()[i], 0.2));
  }
}

TEST_CASE("Fit: the parts of an error bar due to targets and to packings add up",
          "[calibrate][fit]") {
  const auto errors = [](double noise) {
    return fit(soil_parameters(), soil_targets(0.05, 1), simulator_of(soil_formula, noise), nullptr,
               small_options())
        .parameters;
  };
  for (const double noise : {0.0, 0.2}) {
    for (const FittedParameter& p : errors(noise)) {
      INFO(p.name << ", noise " << noise);
      // 1e-9: both parts go through the same gain.
      CHECK_THAT(std::hypot(p.standard_error_targets, p.standard_error_packings),
                 WithinRel(p.standard_error, 1e-9));
      if (noise == 0.0) CHECK(p.standard_error_packings == 0.0);
      // Packings scatter by 0.2 / sqrt(3) = 0.12, the targets by 0.05.
      if (noise > 0.0) CHECK(p.standard_error_packings > 1.3 * p.standard_error_targets);
    }
  }
}

TEST_CASE("Fit: rescaled sigma does not care about the size of sigma", "[calibrate][fit]") {
  const auto summary = [](double sigma, bool rescale) {
    std::vector<Target> targets = soil_targets(0.05, 4);
    for (Target& target : targets) target.sigma = sigma;
    FitOptions options = smooth_fit_options();
    options.rescale_sigma = rescale;
    return fit(soil_parameters(), targets, simulator_of(soil_formula), nullptr, options);
  };
  const FitSummary one = summary(0.05, true);
  const FitSummary other = summary(0.5, true);
  for (std::size_t j = 0; j < 3; ++j) {
    // 1e-5: both searches end within rounding of chi-square, 1e-7 of an error bar.
    CHECK_THAT(other.parameters[j].standard_error,
               WithinRel(one.parameters[j].standard_error, 1e-5));
    CHECK_THAT(summary(0.05, false).parameters[j].standard_error * one.sigma_scale,
               WithinRel(one.parameters[j].standard_error, 1e-5));
    CHECK_THAT(std::log(one.parameters[j].hi95 / one.parameters[j].value),
               WithinRel(3.182446305 * one.parameters[j].standard_error, 1e-8));  // t, 3 degrees
  }
  CHECK_THAT(one.profile_level, WithinRel(3.182446305 * 3.182446305, 1e-8));
}
