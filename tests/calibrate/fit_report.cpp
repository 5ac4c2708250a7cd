// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/fit_report.hpp"

#include <catch2/catch.hpp>

#include "calibrate/fit.hpp"
#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using namespace tilth;
using namespace tilth::test;

namespace {

const ReportContext context{"share of measured targets: 0 of 6"};

FitOptions small_options() {
  FitOptions options;
  options.num_design = 16;
  options.num_rounds = 1;
  options.num_starts = 2;
  return options;
}

}  // namespace

TEST_CASE("Report: it begins with the share of measured targets and has every section in order",
          "[calibrate][report]") {
  std::vector<Target> targets = soil_targets(0.05, 1);
  targets[5].holdout = true;
  std::vector<Parameter> parameters = soil_parameters();
  parameters.push_back(linear_parameter("porosity", 0.3, 0.5, 0.4));
  parameters[3].estimate = false;
  const FitSummary summary =
      fit(parameters, targets, simulator_of(soil_formula, 0.03), nullptr, small_options());
  const std::string text = fit_report_text(summary, context);
  REQUIRE_THAT(text, StartsWith("share of measured targets: 0 of 6\n"));
  std::size_t last = 0;
  for (const char* title :
       {"[[Fit Statistics]]", "[[Gates]]", "[[Warnings]]", "[[Variables]]", "[[Correlations]]",
        "[[Null directions]]", "[[Targets]]", "[[Bias]]", "[[Hold-out]]"}) {
    const std::size_t at = text.find(title);
    INFO(title);
    REQUIRE(at != std::string::npos);
    REQUIRE(at > last);
    last = at;
  }
  REQUIRE_THAT(text, Contains("best value found 2 times of 2 starts"));
  REQUIRE_THAT(text, Contains("sigma: absolute"));
  REQUIRE_THAT(text, Contains("porosity:") && Contains("(fixed)"));
  REQUIRE_THAT(text, Contains("identified") && Contains("+/-") && Contains("(init = 5e+06)"));
  REQUIRE_THAT(text, Contains("noise floor        : passed (measured on 6 seeds"));
  REQUIRE_THAT(text, Contains("hold-out           : passed"));
  REQUIRE_THAT(text, Contains("feature_5") && Contains("synthetic"));
  REQUIRE(text == fit_report_text(summary, context));
}

TEST_CASE("Report: a missing error bar comes with its reason", "[calibrate][report]") {
  FitOptions options = small_options();
  int batches = 0;
  options.progress = [&](const Progress&) { ++batches; };
  options.should_stop = [&] { return batches > 0; };
  const std::string text = fit_report_text(
      fit(soil_parameters(), soil_targets(0.05, 1), simulator_of(soil_formula), nullptr, options),
      context);
  REQUIRE_THAT(text, Contains("no error bar because no local search was completed"));
  REQUIRE_THAT(text, Contains("not known: there is no covariance"));
  REQUIRE_THAT(text, Contains("per curve: - (no measured curve was compared)"));
  REQUIRE_THAT(text, !Contains(" nan"));
}

TEST_CASE("Report: profiles, both parts of the errors, curves and rescaling are said",
          "[calibrate][report]") {
  FitSummary summary = fit(soil_parameters(), soil_targets(0.05, 1),
                           simulator_of(soil_formula, 0.03), nullptr, small_options());
  REQUIRE(summary.profiles.size() == 3);
  summary.sample_sizes.push_back({"shear_10000Pa", 200, 12.25});
  const std::string text = fit_report_text(summary, context);
  REQUIRE_THAT(text, Contains("profiles: 95 % where chi-square rises by 3.841"));
  REQUIRE_THAT(text, Contains("drawn on emulators of the search runs"));
  REQUIRE_THAT(text, Contains("se from targets") && Contains("from packings"));
  REQUIRE_THAT(text, Contains("per curve:\n") &&
                         Contains("effective sample size of shear_10000Pa: 12.2 of 200 points"));
  REQUIRE_THAT(text, Contains("equivalence family: "));
  summary.sigma_is_rescaled = true;
  summary.sigma_scale = 1.5;
  summary.degrees_of_freedom = 3;
  const std::string rescaled = fit_report_text(summary, context);
  REQUIRE_THAT(rescaled,
               Contains("sigma: rescaled by reduced chi-square (standard errors times 1.5)"));
  REQUIRE_THAT(rescaled, Contains("Student's t with 3 degrees of freedom"));
}

TEST_CASE("Report: a fit that did not run is one sentence", "[calibrate][report]") {
  REQUIRE(fit_report_text(FitSummary{}, context) ==
          "share of measured targets: 0 of 6\nnot_called: fit() was not called\n");
}
