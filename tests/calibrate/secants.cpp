// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/secants.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::WithinAbs;
using namespace tilth;
using namespace tilth::test;

namespace {

struct Bench {
  SimulationLedger ledger;
  std::vector<Parameter> parameters = soil_parameters();
  std::vector<Target> targets = soil_targets(0.1, 0);
  std::vector<std::uint64_t> seeds = {1, 2};
  std::size_t num_batches = 0;

  std::optional<Secants> run(const Simulator& simulator, const Eigen::VectorXd& unit, double step) {
    ledger.max_simulations = 1000;
    const Simulator counted = [&](const Eigen::MatrixXd& p, std::span<const std::uint64_t> s) {
      ++num_batches;
      return simulator(p, s);
    };
    Evaluator evaluator(counted, targets, "search", ledger);
    return paired_secants(evaluator, parameters, targets, unit, Eigen::Vector3d::Constant(step),
                          seeds);
  }
};

const Eigen::Vector3d middle(0.4, 0.5, 0.6);

// Analytic d ln f / d u of two features: ln f0 = ln E + 0.3 ln(1 + mu), ln f3 = ln(0.2 + mu).
double exact_stiffness_slope() {
  const Parameter p = soil_parameters()[2];
  const double friction = physical_from_unit(p, middle[2]);
  return 0.3 * friction / (1.0 + friction) * coordinate_span(p);
}

}  // namespace

TEST_CASE("Secants: central differences are of second order, one-sided ones of first",
          "[calibrate][secants]") {
  const auto error = [](double step, bool one_sided) {
    Bench bench;
    const double top = middle[2] + 0.5 * step;
    Simulator simulator = simulator_of(soil_formula, 0.05);
    if (one_sided) {
      const double limit = physical_from_unit(bench.parameters[2], top);
      simulator = failing(simulator, [limit](const Eigen::VectorXd& p) { return p[2] > limit; });
    }
    const auto secants = bench.run(simulator, middle, step);
    REQUIRE(secants->one_sided.size() == (one_sided ? 1U : 0U));
    return std::abs(secants->jacobian(0, 2) - exact_stiffness_slope());
  };
  // Halving the step divides the error by 4 (2 one-sided); 5 %: the next order at step 0.04.
  REQUIRE_THAT(error(0.04, false) / error(0.02, false), WithinAbs(4.0, 0.2));
  REQUIRE_THAT(error(0.04, true) / error(0.02, true), WithinAbs(2.0, 0.1));
}

TEST_CASE("Secants: all members of a seed ride in one batch, packing noise cancels",
          "[calibrate][secants]") {
  Bench quiet;
  Bench noisy;
  const auto without = quiet.run(simulator_of(soil_formula), middle, 0.02);
  const auto with = noisy.run(simulator_of(soil_formula, 0.2), middle, 0.02);
  REQUIRE(noisy.num_batches == 1);  // all seeds side by side
  REQUIRE(noisy.ledger.num_done == 7 * noisy.seeds.size());
  // 1e-12: noise multiplies, so it drops out of differences of logarithms, to rounding / step.
  REQUIRE((with->jacobian - without->jacobian).cwiseAbs().maxCoeff() < 1e-12);
  REQUIRE((with->base - without->base).cwiseAbs().maxCoeff() > 0.01);
}

TEST_CASE("Secants: at a bound the inner side is used", "[calibrate][secants]") {
  Bench bench;
  const auto secants = bench.run(simulator_of(soil_formula), Eigen::Vector3d(0.0, 1.0, 0.5), 0.02);
  REQUIRE(secants->one_sided == std::vector<std::size_t>{0, 1});
  REQUIRE(secants->frozen.empty());
  // ln f4 = (ln E + ln S) / 2 is linear in u: one side is exact; spans are ln 100 both.
  REQUIRE_THAT(secants->jacobian(4, 0), WithinAbs(0.5 * std::log(100.0), 1e-11));
  REQUIRE_THAT(secants->jacobian(4, 1), WithinAbs(0.5 * std::log(100.0), 1e-11));
}

TEST_CASE("Secants: a parameter whose both sides fail is frozen, the others are not",
          "[calibrate][secants]") {
  Bench bench;
  const double centre = physical_from_unit(bench.parameters[1], middle[1]);
  const auto fails = [centre](const Eigen::VectorXd& p) { return p[1] != centre; };
  const auto secants = bench.run(failing(simulator_of(soil_formula), fails), middle, 0.02);
  REQUIRE(secants->frozen == std::vector<std::size_t>{1});
  REQUIRE(secants->jacobian.col(1).isZero(0.0));
  REQUIRE(secants->jacobian(0, 0) != 0.0);
}

TEST_CASE("Secants: without the point itself there are none", "[calibrate][secants]") {
  Bench bench;
  const auto always = [](const Eigen::VectorXd&) { return true; };
  REQUIRE_FALSE(bench.run(failing(simulator_of(soil_formula), always), middle, 0.02));
}

TEST_CASE("Secants: a step stated by the parameter wins over the options, in the coordinate",
          "[calibrate][secants]") {
  std::vector<Parameter> parameters = {log_parameter("a", 1.0, std::exp(2.0), 2.0),
                                       linear_parameter("b", 0.0, 10.0, 5.0),
                                       linear_parameter("c", 0.0, 10.0, 5.0)};
  parameters[2].secant_step = 2.0;
  const Eigen::VectorXd steps = secant_steps(parameters, 0.05, 0.04);
  // 1e-15: one division.
  REQUIRE_THAT(steps[0], WithinAbs(0.025, 1e-15));
  REQUIRE_THAT(steps[1], WithinAbs(0.04, 1e-15));
  REQUIRE_THAT(steps[2], WithinAbs(0.2, 1e-15));
}

TEST_CASE("Secants: the noise of single runs is read from second differences and carried to the derivatives",
          "[calibrate][secants]") {
  // Features that do not depend on the parameters, but every run is off by a normal number of its own.
  constexpr double scatter = 0.05;
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(3, 3);
  Eigen::MatrixXd shape;
  double squares = 0.0;
  constexpr int num_points = 400;
  for (int point = 0; point < num_points; ++point) {
    std::uint64_t run = static_cast<std::uint64_t>(point) << 32;
    const Simulator noisy = [&](const Eigen::MatrixXd& p, std::span<const std::uint64_t> s) {
      std::vector<Evaluation> runs = simulator_of([](const Eigen::VectorXd&) { return soil_formula(soil_truth()); })(p, s);
      for (Evaluation& r : runs) {
        ++run;
        for (Eigen::Index k = 0; k < r.features.size(); ++k)
          r.features[k] *= std::exp(scatter * normal_number(5, run, static_cast<std::uint64_t>(k)));
      }
      return runs;
    };
    Bench bench;
    const auto secants = bench.run(noisy, Eigen::Vector3d(0.02, 0.5, 0.99), 0.05);  // two one-sided
    REQUIRE(secants->one_sided.size() == 2);
    REQUIRE(secants->second_differences.cols() == 1);
    squares += secants->second_differences.squaredNorm();
    products += secants->jacobian.transpose() * secants->jacobian;
    shape = secants->noise_shape;
  }
  constexpr double num_values = 6.0 * num_points;         // six features
  constexpr double variance = scatter * scatter / 2.0;    // of a mean over two packings
  const double error = std::sqrt(2.0 / num_values);       // of a mean of squares, relative
  REQUIRE(std::abs(squares / num_values / 6.0 / variance - 1.0) < 4.0 * error);
  const Eigen::MatrixXd found = products / num_values / variance;
  REQUIRE((found - shape).cwiseAbs().maxCoeff() < 4.0 * error * shape.maxCoeff());
  // Up and down from one run: the error in common pulls them apart.
  REQUIRE(shape(0, 2) == Approx(-1.0 / (0.05 * 0.05)));
  REQUIRE(shape(1, 1) == Approx(0.5 / (0.05 * 0.05)));
  REQUIRE(shape(0, 0) == Approx(2.0 / (0.05 * 0.05)));
}
