// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/row_bootstrap.hpp"
#include "calibrate/sensitivity_report.hpp"
#include "tests/calibrate/sensitivity_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

double additive(const Eigen::VectorXd& x) { return x[0] + 2.0 * x[1]; }

SensitivitySummary run_one(const Simulator& simulator, const SensitivityOptions& options) {
  return run_sensitivity(unit_parameters(2), {plain_target("y")}, simulator, options);
}

}  // namespace

TEST_CASE("Bootstrap: 95 % intervals of a mean of independent rows hold it as often as promised",
          "[calibrate][sensitivity]") {
  const RowStatistic mean = [](const Eigen::VectorXd& means, const Eigen::VectorXd&) {
    return means;
  };
  int num_hits = 0;
  const int num_trials = 400;
  for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(num_trials); ++k) {
    RowTerms terms(1, 60);
    for (Eigen::Index r = 0; r < 60; ++r)
      terms.add(0, r, normal_number(9, k, static_cast<std::uint64_t>(r)));
    const RowEstimates e = bootstrap(terms, mean, 300, k);
    num_hits += e.low95[0] <= 0.0 && 0.0 <= e.high95[0] ? 1 : 0;
  }
  // Percentile intervals of 60 rows cover 94 %; three standard deviations of 400 trials are 3.4 %.
  CHECK(num_hits >= 362);
  CHECK(num_hits <= 390);
}

TEST_CASE("Sobol: bootstrap intervals of an additive function hold the exact indices",
          "[calibrate][sensitivity]") {
  // Nine parameters: the design is random there, so rows are independent as the bootstrap assumes.
  const auto sum = one_output([](const Eigen::VectorXd& x) { return additive(x); });
  int num_hits = 0;
  const int num_trials = 60;
  for (int k = 0; k < num_trials; ++k) {
    const SensitivitySummary s =
        run_sensitivity(unit_parameters(9), {plain_target("y")}, simulator_of(sum),
                        study(SensitivityMethod::sobol, 100, 1 + static_cast<std::uint64_t>(k)));
    const IndexEstimate first = index_of(s, IndexKind::first_order, 1);
    const IndexEstimate total = index_of(s, IndexKind::total, 0);
    num_hits += first.low95 <= 0.8 && 0.8 <= first.high95 ? 1 : 0;
    num_hits += total.low95 <= 0.2 && 0.2 <= total.high95 ? 1 : 0;
  }
  // 95 % of 120, less three standard deviations (2.4 each) and 3 % for percentiles of few rows.
  CHECK(num_hits >= 103);
}

TEST_CASE("Sensitivity: a stop gives the result of the finished rows", "[calibrate][sensitivity]") {
  SensitivityOptions options = study(SensitivityMethod::sobol, 64, 1, 4);
  int num_questions = 0;
  options.should_stop = [&num_questions] { return ++num_questions > 3; };
  const Simulator model = simulator_of(one_output(additive));
  const SensitivitySummary stopped = run_one(model, options);
  CHECK(stopped.end == SensitivityEnd::stopped);
  CHECK(stopped.num_rows == 24);  // three batches of two rows per packing
  const SensitivitySummary short_one = run_one(model, study(SensitivityMethod::sobol, 24, 1, 4));
  CHECK(short_one.end == SensitivityEnd::completed);
  CHECK(index_of(stopped, IndexKind::total, 1).value ==
        index_of(short_one, IndexKind::total, 1).value);
  CHECK(index_of(stopped, IndexKind::total, 1).low95 ==
        index_of(short_one, IndexKind::total, 1).low95);

  options.should_stop = [] { return true; };
  const SensitivitySummary nothing = run_one(model, options);
  CHECK(nothing.num_rows == 0);
  CHECK_FALSE(nothing.has_indices());
  CHECK_THAT(sensitivity_report_text(nothing, {}), Contains("no row was finished"));
}

TEST_CASE("Sensitivity: a budget ends it on a whole row", "[calibrate][sensitivity]") {
  SensitivityOptions options = study(SensitivityMethod::sobol, 64, 1, 2);
  options.max_simulations = 45;
  int num_simulated = 0;
  const Simulator model = simulator_of(one_output(additive));
  const SensitivitySummary s = run_one(
      [&](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
        num_simulated += static_cast<int>(parameters.cols());
        return model(parameters, seeds);
      },
      options);
  CHECK(s.end == SensitivityEnd::budget_spent);
  CHECK(s.num_rows >= 4);
  CHECK(num_simulated == 45);
  CHECK(s.num_runs <= 45);
  // Two parameters: AB_1 and BA_2 are one point, simulated and counted once.
  CHECK(s.num_runs < s.runs.size());
  CHECK(s.has_indices());
}

TEST_CASE("Sensitivity: if all runs fail that is said of every feature",
          "[calibrate][sensitivity]") {
  const SensitivitySummary s =
      run_one(failing(simulator_of(one_output(additive)), [](const auto&) { return true; }),
              study(SensitivityMethod::morris, 8));
  CHECK_FALSE(s.has_indices());
  CHECK(s.features.front().no_indices == "all runs failed");
  CHECK_THAT(sensitivity_report_text(s, {}),
             Contains("all runs failed") && Contains("100 %") && Contains("the packing exploded"));
}

TEST_CASE("Sensitivity: a test that fails takes no other test's features with it",
          "[calibrate][sensitivity]") {
  // Feature 0 fails for x1 > 0.9 and leaves its reason, as a partial simulator does.
  const Simulator partial = [](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t>) {
    std::vector<Evaluation> runs;
    for (const auto& x : parameters.colwise()) {
      const bool fails = x[0] > 0.9;
      runs.push_back({EvaluationStatus::completed,
                      Eigen::Vector2d(fails ? std::nan("") : additive(x), additive(x)),
                      fails ? "direct_shear (timeout): after 3 s" : ""});
    }
    return runs;
  };
  const SensitivitySummary s =
      run_sensitivity(unit_parameters(2), {plain_target("cut"), plain_target("whole")}, partial,
                      study(SensitivityMethod::sobol, 64));
  CHECK(s.num_failed > 0);
  CHECK(s.num_failed < s.num_runs / 4);
  CHECK(s.features[0].failures.verdict == FailureVerdict::concentrated);
  CHECK(s.features[1].failures.num_failed == 0);
  CHECK(std::isnan(s.features[1].indices.front().bound_low));
  CHECK(std::isfinite(s.features[0].indices.front().bound_low));
  CHECK_THAT(sensitivity_report_text(s, {}), Contains("direct_shear (timeout): after"));
  CHECK_THAT(samples_csv(s, unit_parameters(2), {}), Contains(",partial,"));
}

TEST_CASE("Sensitivity: a value without logarithm is missing for its own feature alone",
          "[calibrate][sensitivity]") {
  const auto two = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::Vector2d(x[0] - 0.1, additive(x));
  };
  Target log_one = plain_target("y_log");
  log_one.log_transform = true;
  log_one.value = 1.0;
  const SensitivitySummary s =
      run_sensitivity(unit_parameters(2), {log_one, plain_target("y")}, simulator_of(two),
                      study(SensitivityMethod::sobol, 64));
  CHECK(s.num_failed == 0);
  CHECK_THAT(s.features[0].failures.share(), WithinAbs(0.1, 0.02));
  CHECK(s.features[0].failures.verdict == FailureVerdict::concentrated);
  CHECK(s.features[1].failures.num_failed == 0);
  const std::string text = sensitivity_report_text(s, {});
  CHECK_THAT(text, Contains("scale         : ln(value)") && Contains("CONCENTRATED") &&
                       Contains("scale         : value, SI unit"));
}

TEST_CASE("Sensitivity: an emulator of few points finds the indices and says it is one",
          "[calibrate][sensitivity]") {
  const auto smooth = [](const Eigen::VectorXd& x) { return x[0] + 2.0 * x[1] * x[1]; };
  // V1 = 1/12, V2 = 4 (1/5 - 1/9) = 16/45.
  const double share = (1.0 / 12.0) / (1.0 / 12.0 + 16.0 / 45.0);
  const SensitivitySummary s =
      run_one(noisy(smooth, 0.05, NoiseKind::independent), study(SensitivityMethod::emulator, 48));
  CHECK(s.num_runs == 48 + 24);  // every second point twice
  CHECK_THAT(index_of(s, IndexKind::first_order, 0).value, WithinAbs(share, 0.02));
  CHECK_THAT(index_of(s, IndexKind::total, 1).value, WithinAbs(1.0 - share, 0.02));
  const FeatureSensitivity& f = s.features.front();
  CHECK(f.emulator.q2 > 0.98);
  // v = 0.0025 of V = 0.44: 24 squared differences know it to 30 %.
  CHECK_THAT(f.noise.noise_share, WithinRel(0.0057, 0.9));
  const std::string text = sensitivity_report_text(s, {});
  CHECK_THAT(text, Contains("EMULATOR") && Contains("leave-one-out"));
  CHECK_THAT(sensitivity_csv(s, {}), Contains("sobol by emulator"));
}

TEST_CASE("Sensitivity: everything wrong with a study is said at once",
          "[calibrate][sensitivity]") {
  SensitivityOptions options = study(SensitivityMethod::morris, 2);
  options.levels = 5;
  options.packings.num_packings = 0;
  std::vector<Parameter> parameters = unit_parameters(1);
  parameters.front().estimate = false;
  std::string all;
  for (const std::string& sentence : problems(parameters, options)) all += sentence + "\n";
  CHECK_THAT(all, Contains("no parameter is free") && Contains("samples = 2: must be 4 or more") &&
                      Contains("levels = 5: must be even") && Contains("packings = 0"));
  options = study(SensitivityMethod::emulator, 1000);
  CHECK(problems(unit_parameters(2), options).size() == 1);
  CHECK(problems(unit_parameters(2), study(SensitivityMethod::sobol, 8)).empty());
}

TEST_CASE("Sensitivity report: level count, noise share, intervals and PREVIEW are in it",
          "[calibrate][sensitivity]") {
  const SensitivityContext context{"loamy_sand", "measured targets: 0 of 1", true};
  const SensitivitySummary morris =
      run_one(noisy(additive, 0.1, NoiseKind::independent), study(SensitivityMethod::morris, 16));
  CHECK_THAT(sensitivity_report_text(morris, context),
             Contains("PREVIEW") && Contains("4 levels") && Contains("packing noise : ") &&
                 Contains("of the variance of one run") &&
                 Contains("0 failed in a test or more (0 %)") &&
                 Contains("mu_star of a parameter without effect"));
  CHECK_THAT(sensitivity_csv(morris, context), Contains("PREVIEW"));
  CHECK_THAT(samples_csv(morris, unit_parameters(2), context), Contains("PREVIEW"));
  const SensitivitySummary sobol =
      run_one(noisy(additive, 0.1, NoiseKind::independent), study(SensitivityMethod::sobol, 16));
  CHECK_THAT(sensitivity_report_text(sobol, context),
             Contains("Sij x1 x x2") && Contains("--emulator"));
}
