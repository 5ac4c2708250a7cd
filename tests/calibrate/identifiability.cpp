// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Published cases of parameters that data do not fix, through fit(): the right verdict for each.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "calibrate/fit.hpp"
#include "calibrate/fit_report.hpp"
#include "calibrate/student_t.hpp"
#include "tests/calibrate/formula_models.hpp"
#include "tests/calibrate/nist_problems.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

std::vector<Target> measured(const std::vector<double>& values, double sigma) {
  std::vector<Target> targets(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    targets[k].name = "y_" + std::to_string(k);
    targets[k].value = values[k];
    targets[k].sigma = sigma;
    targets[k].statistic = "y";
  }
  return targets;
}

// y = k1 / k2 x, x = 1 .. 10, sigma 0.1, k1 = 2, k2 = 1.
FitSummary ratio_fit(double k2_upper) {
  std::vector<double> y;
  for (int i = 1; i <= 10; ++i)
    y.push_back(2.0 * i + 0.1 * normal_number(5, 1, static_cast<std::uint64_t>(i)));
  return fit({linear_parameter("k1", 0.01, 100.0, 2.0), linear_parameter("k2", 0.2, k2_upper, 1.0)},
             measured(y, 0.1), simulator_of([](const Eigen::VectorXd& p) {
               return Eigen::VectorXd(p[0] / p[1] * Eigen::VectorXd::LinSpaced(10, 1.0, 10.0));
             }),
             nullptr, smooth_fit_options());
}

}  // namespace

TEST_CASE("Identifiability: a ratio's numerator is limited only by the bound of its denominator",
          "[calibrate][identifiability]") {
  const FitSummary summary = ratio_fit(5.0);
  REQUIRE(summary.profiles.size() == 2);
  CHECK(verdict_words(summary.parameters[0]) == "bound_limited(by=k2)");
  CHECK(summary.null_directions.size() == 1);
  CHECK_THAT(summary.parameters[0].no_error_bar, Contains("do not fix"));
  // k1 / k2 is known to 0.1 / sqrt(sum x^2) = 0.0051: k1 can go as far as 2 x the bounds of k2,
  // 1.96 x 0.0051 of the ratio beyond; half a per cent covers the noise of y.
  CHECK_THAT(summary.parameters[0].profile_lo95, WithinRel(0.2 * (2.0 - 0.01), 0.01));
  CHECK_THAT(summary.parameters[0].profile_hi95, WithinRel(5.0 * (2.0 + 0.01), 0.01));
  // k1 has room for every k2: nothing stops k2 but its own bounds.
  CHECK(summary.parameters[1].verdict == ParameterVerdict::flat);
  for (std::size_t i = 0; i < summary.profiles[0].values.size(); ++i) {
    const bool is_beyond =
        summary.profiles[0].values[i] > 10.2 || summary.profiles[0].values[i] < 0.39;
    if (is_beyond) CHECK(summary.profiles[0].at_bound[i] == "k2");
  }
  // The family spreads along the ratio.
  CHECK(summary.equivalence_family.size() >= 8);
  double least = 100.0, most = 0.0;
  for (const EquivalentSet& set : summary.equivalence_family) {
    CHECK(set.chi_square_difference <= summary.profile_level);
    CHECK_THAT(set.values[0] / set.values[1], WithinAbs(2.0, 0.05));
    least = std::min(least, set.values[0]);
    most = std::max(most, set.values[0]);
  }
  CHECK(most / least > 10.0);
}

TEST_CASE("Identifiability: flood heights fix one combination of Strickler coefficient and levels",
          "[calibrate][identifiability]") {
  // H = (Q / (Ks B sqrt((Zm - Zv) / L)))^0.6, B = 300 m, L = 5000 m; truth 30, 50 m, 55 m;
  // synthetic with sigma 0.05 m. Every parameter can be made up for by the others within these
  // bounds.
  const Eigen::VectorXd flow = Eigen::VectorXd::LinSpaced(10, 200.0, 2000.0);
  const auto height = [flow](const Eigen::VectorXd& p) {
    const double slope = (p[2] - p[1]) / 5000.0;
    return Eigen::VectorXd((flow.array() / (p[0] * 300.0 * std::sqrt(slope))).pow(0.6));
  };
  const Eigen::VectorXd truth = height(Eigen::Vector3d(30.0, 50.0, 55.0));
  std::vector<double> y;
  for (Eigen::Index i = 0; i < 10; ++i)
    y.push_back(truth[i] + 0.05 * normal_number(6, 1, static_cast<std::uint64_t>(i)));
  const FitSummary summary =
      fit({linear_parameter("Ks", 27.0, 36.0, 30.0), linear_parameter("Zv_m", 48.0, 52.0, 50.0),
           linear_parameter("Zm_m", 53.0, 57.0, 55.0)},
          measured(y, 0.05), simulator_of(height), nullptr, smooth_fit_options());
  CHECK(summary.null_directions.size() == 2);
  for (const FittedParameter& p : summary.parameters) {
    INFO(p.name);
    CHECK(p.verdict == ParameterVerdict::flat);
    CHECK_THAT(p.no_error_bar, Contains("do not fix"));
  }
  CHECK_THAT(fit_report_text(summary, {"synthetic"}), Contains("the data do not fix"));
}

TEST_CASE("Identifiability: Chaboche's exponent has an unknown sign",
          "[calibrate][identifiability]") {
  // sigma = R + C (1 - exp(-g e)) / g; the ten stresses of OpenTURNS, sigma 10 MPa.
  const Eigen::VectorXd strain = Eigen::VectorXd::LinSpaced(10, 0.0, 0.07);
  const std::vector<double> stress = {7.56e8, 7.57e8, 7.85e8, 8.19e8, 8.01e8,
                                      8.42e8, 8.49e8, 8.79e8, 8.85e8, 8.96e8};
  const auto model = simulator_of([strain](const Eigen::VectorXd& p) {
    const double g = p[2];
    Eigen::VectorXd shape = strain;
    if (std::abs(g) > 1e-12)
      for (double& e : shape) e = -std::expm1(-g * e) / g;
    return Eigen::VectorXd(p[0] + p[1] * shape.array());
  });
  const auto fitted = [&](double lower) {
    return fit({linear_parameter("R_Pa", 5e8, 1e9, 7e8), linear_parameter("C_Pa", 1e8, 1e10, 2e9),
                linear_parameter("gamma", lower, 60.0, 8.0)},
               measured(stress, 1e7), model, nullptr, smooth_fit_options());
  };
  // With room on both sides the interval contains zero: not even the sign is known.
  const FitSummary wide = fitted(-60.0);
  CHECK(wide.parameters[2].verdict == ParameterVerdict::identified);
  CHECK(wide.parameters[2].profile_lo95 < 0.0);
  CHECK(wide.parameters[2].profile_hi95 > 0.0);
  CHECK(wide.parameters[0].verdict == ParameterVerdict::identified);
  // A hardening law with gamma >= 0 gives an upper limit only.
  const FitSummary hardening = fitted(0.0);
  CHECK(hardening.parameters[2].verdict == ParameterVerdict::one_sided);
  CHECK(std::isnan(hardening.parameters[2].profile_lo95));
  CHECK_THAT(hardening.parameters[2].profile_hi95,
             WithinRel(wide.parameters[2].profile_hi95, 0.01));
}

TEST_CASE("Identifiability: Bennett5 converges and is reported as nearly unidentifiable",
          "[calibrate][identifiability][nist]") {
  const std::vector<NistProblem> problems = nist_problems();
  const NistProblem& bennett = nist_problem(problems, "Bennett5");
  std::vector<Parameter> parameters = nist_parameters(bennett, 1);
  for (std::size_t j = 0; j < 3; ++j) parameters[j].start = bennett.parameters[j].certified;
  const FitSummary summary =
      fit(parameters, nist_targets(bennett), nist_simulator(bennett), nullptr, nist_options());
  REQUIRE(summary.termination == Termination::converged);
  // The largest correlation of the certified fit, to its six digits.
  CHECK_THAT(summary.correlation.cwiseAbs()
                 .unaryExpr([](double c) { return c < 1.0 - 1e-12 ? c : 0.0; })
                 .maxCoeff(),
             WithinAbs(0.999997, 5e-7));
  const bool warned = std::ranges::any_of(summary.warnings, [](const std::string& w) {
    return w.starts_with("nearly unidentifiable") && w.find("b1") != std::string::npos;
  });
  CHECK(warned);
  REQUIRE(summary.near_null_directions.size() == 1);
  const std::string text = fit_report_text(summary, {"NIST StRD"});
  CHECK_THAT(text, Contains("nearly unidentifiable") && Contains("the data barely fix"));
  CHECK_THAT(text, Contains("sigma: rescaled by reduced chi-square"));
}

TEST_CASE("NIST: MGH17 has the published 95 % intervals of Student's t", "[calibrate][nist]") {
  const std::vector<NistProblem> problems = nist_problems();
  const NistProblem& mgh17 = nist_problem(problems, "MGH17");
  const FitSummary summary = fit(nist_parameters(mgh17, 1), nist_targets(mgh17),
                                 nist_simulator(mgh17), nullptr, nist_options());
  const double published[5][2] = {{0.371165106533, 0.37965499768},
                                  {1.4845486269, 2.38714519852},
                                  {-1.91893591768, -1.01043835555},
                                  {0.0119485913765, 0.0137864779036},
                                  {0.0202899488939, 0.0239554504294}};
  CHECK(summary.interval_factor == student_t_half_width(0.95, 28));
  for (std::size_t j = 0; j < 5; ++j) {
    INFO(summary.parameters[j].name);
    // Twelve published digits; 1e-7: eight digits of the fitted values.
    CHECK_THAT(summary.parameters[j].lo95, WithinRel(published[j][0], 1e-7));
    CHECK_THAT(summary.parameters[j].hi95, WithinRel(published[j][1], 1e-7));
  }
}
