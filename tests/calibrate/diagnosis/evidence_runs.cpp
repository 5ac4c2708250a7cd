// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Evidence and refits against formulas whose derivatives, fingerprints and best points are known.
#include "calibrate/diagnosis/evidence_runs.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "calibrate/diagnosis/effect_refit.hpp"
#include "tests/calibrate/formula_models.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Power laws: ln f = A (ln a, ln b) + s * alpha + ln(packing).
const Eigen::MatrixXd exponents = (Eigen::MatrixXd(4, 2) << 1.0, 0.0, 0.5, 0.5, 0.0, 1.0, -0.3, 0.8).finished();
const Eigen::Vector4d fingerprint(0.0, 0.4, -0.2, 0.6);

Eigen::VectorXd power_laws(const Eigen::VectorXd& v) {
  const Eigen::Vector2d logs(std::log(v[0]), std::log(v[1]));
  return (exponents * logs + fingerprint * v[2]).array().exp();
}

Parameter free_parameter(const std::string& name, double start) {
  Parameter p;
  p.name = name;
  p.lower = 0.1;
  p.upper = 10.0;
  p.start = start;
  p.log_scale = true;
  return p;
}

Parameter effect_parameter() {
  Parameter p;
  p.name = "effect";
  p.lower = 0.0;
  p.upper = 2.0;
  p.start = 0.0;
  p.estimate = false;
  return p;
}

struct Problem {
  std::vector<Parameter> parameters = {free_parameter("a", 1.0), free_parameter("b", 2.0), effect_parameter()};
  std::vector<Target> targets;
  SimulationLedger ledger;
  Problem() {
    for (const char* name : {"f0", "f1", "f2", "f3"}) {
      Target t;
      t.name = name;
      t.value = 1.0;
      t.log_transform = true;
      targets.push_back(t);
    }
    ledger.max_simulations = 100'000;
    ledger.max_failed_share = 1.0;
  }
  Evaluator evaluator(const Simulator& simulator) {
    return Evaluator(simulator, targets, "test", ledger, TargetScope::all, MissingFeatures::keep);
  }
};

EffectStep step_to(double size) {
  EffectStep step;
  step.settings = {{2, size}};
  return step;
}

EvidencePlan plan_of(int num) {
  EvidencePlan plan;
  for (int k = 0; k < num; ++k) {
    plan.residual_seeds.push_back(100 + static_cast<std::uint64_t>(k));
    plan.derivative_seeds.push_back(200 + static_cast<std::uint64_t>(k));
  }
  return plan;
}

/// Feature `which` is missing on packings for which the effect is on and `seed_fails` says so.
Simulator losing(const Simulator& inner, Eigen::Index which, std::function<bool(double, std::uint64_t)> fails) {
  return [=](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<Evaluation> runs = inner(parameters, seeds);
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (fails(parameters(2, static_cast<Eigen::Index>(i)), seeds[i])) {
        runs[i].features[which] = nan_value;
        runs[i].message = "test broke";
      }
    return runs;
  };
}

}  // namespace

TEST_CASE("Evidence: derivatives and fingerprints of power laws are exact, packings cancel", "[diagnosis]") {
  Problem problem;
  Evaluator evaluator = problem.evaluator(simulator_of(power_laws, 0.1));
  const Eigen::VectorXd unit = unit_start(problem.parameters);
  const auto e = simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit, {step_to(0.5)}, plan_of(5));
  REQUIRE(e);
  const double span = std::log(100.0);
  CHECK((e->jacobian - exponents * span).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((e->fingerprints.col(0) - fingerprint).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(e->jacobian_variances.maxCoeff() < 1e-14);
  CHECK(e->fingerprint_variances.maxCoeff() < 1e-14);
  CHECK(e->not_simulated[0].empty());
  // the packings themselves scatter, and stand for the point
  REQUIRE(e->packings.rows() == 5);
  const Eigen::VectorXd exact = power_laws(physical_point(problem.parameters, unit)).array().log();
  CHECK((e->packings.colwise().mean().transpose() - exact).cwiseAbs().maxCoeff() < 0.2);
  CHECK((e->packings.rowwise() - e->packings.row(0)).cwiseAbs().maxCoeff() > 0.01);
  CHECK(problem.ledger.num_done == 5 + 5 * (1 + 2 * 2 + 1));
}

TEST_CASE("Evidence: held-out numbers are simulated at the point only", "[diagnosis]") {
  Problem problem;
  problem.targets[3].holdout = true;
  Evaluator all = problem.evaluator(simulator_of(power_laws, 0.1));
  Evaluator fitted(losing(simulator_of(power_laws, 0.1), 3, [](double, std::uint64_t) { return true; }), problem.targets,
                   "test", problem.ledger, TargetScope::fitted, MissingFeatures::keep);
  const auto e = simulate_evidence(all, fitted, {0, 1, 2}, problem.parameters, problem.targets, unit_start(problem.parameters),
                                   {step_to(0.5)}, plan_of(4));
  REQUIRE(e);
  CHECK(e->packings.allFinite());
  CHECK(e->not_simulated[0].empty());
  CHECK(e->fingerprints.topRows(3).allFinite());
  CHECK_FALSE(std::isfinite(e->fingerprints(3, 0)));
}

TEST_CASE("Evidence: effects that no test depends on cost nothing and are said to be so", "[diagnosis]") {
  Problem problem;
  Evaluator evaluator = problem.evaluator(simulator_of(power_laws, 0.1));
  EffectStep idle = step_to(0.5);
  idle.is_active = false;
  const auto e = simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit_start(problem.parameters), {idle}, plan_of(4));
  REQUIRE(e);
  CHECK(e->not_simulated[0] == "none of these tests depends on it");
  CHECK(problem.ledger.num_done == 4 + 4 * (1 + 2 * 2));
}

TEST_CASE("Evidence: costly effects are compared on the first packings only", "[diagnosis]") {
  Problem problem;
  Evaluator evaluator = problem.evaluator(simulator_of(power_laws, 0.1));
  EffectStep costly = step_to(0.5);
  costly.is_costly = true;
  EvidencePlan plan = plan_of(6);
  plan.costly_packings = 2;
  const auto e = simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit_start(problem.parameters), {costly}, plan);
  REQUIRE(e);
  CHECK((e->fingerprints.col(0) - fingerprint).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(problem.ledger.num_done == 6 + 6 * (1 + 2 * 2) + 2);
}

TEST_CASE("Evidence: what a failed test lacks is left out, an effect never compared is excluded with the reason", "[diagnosis]") {
  Problem problem;
  const Simulator whole = simulator_of(power_laws, 0.1);
  const Eigen::VectorXd unit = unit_start(problem.parameters);
  SECTION("on some packings") {
    Evaluator evaluator = problem.evaluator(losing(whole, 1, [](double effect, std::uint64_t seed) { return effect > 0 && seed < 203; }));
    const auto e = simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit, {step_to(0.5)}, plan_of(5));
    REQUIRE(e);
    CHECK(e->fingerprints(1, 0) == Approx(fingerprint[1]));
    CHECK(e->not_simulated[0].empty());
  }
  SECTION("on all") {
    Evaluator evaluator = problem.evaluator(losing(whole, 1, [](double effect, std::uint64_t) { return effect > 0; }));
    const auto e = simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit, {step_to(0.5)}, plan_of(5));
    REQUIRE(e);
    CHECK(std::isnan(e->fingerprints(1, 0)));
    CHECK(e->not_simulated[0] == "test broke");
  }
  SECTION("at the point itself there is no evidence") {
    Evaluator evaluator = problem.evaluator(losing(whole, 1, [](double, std::uint64_t seed) { return seed != 100; }));
    CHECK_FALSE(simulate_evidence(evaluator, evaluator, {0, 1, 2, 3}, problem.parameters, problem.targets, unit, {step_to(0.5)}, plan_of(5)));
  }
}

namespace {

/// A problem whose data are made at (a, b, effect) = (1.8, 0.9, size), without noise.
struct RefitCase {
  Problem problem;
  Eigen::VectorXd measured;
  explicit RefitCase(double size) {
    measured = power_laws(Eigen::Vector3d(1.8, 0.9, size)).array().log();
  }
  RefitProblem data(std::vector<Eigen::Index> fitted) const {
    return {problem.parameters,      problem.targets, measured, 0.01 * Eigen::MatrixXd::Identity(4, 4),
            exponents * std::log(100.0), std::move(fitted), {300, 301}};
  }
};

FreeEffect free_effect() { return {2, 0.0, 2.0, fingerprint}; }

}  // namespace

TEST_CASE("Refit: parameters and size of an effect are found, held-out numbers predicted", "[diagnosis]") {
  RefitCase c(0.7);
  Evaluator evaluator = c.problem.evaluator(simulator_of(power_laws));
  const RefitProblem problem = c.data({0, 1, 2});  // three numbers, three unknowns; the fourth is predicted
  const Refit r = refit(evaluator, problem, unit_start(c.problem.parameters), {free_effect()}, Eigen::VectorXd::Zero(1), 4);
  REQUIRE(r.is_usable);
  CHECK(r.sizes[0] == Approx(0.7));
  CHECK(physical_from_unit(c.problem.parameters[0], r.unit[0]) == Approx(1.8));
  CHECK(physical_from_unit(c.problem.parameters[1], r.unit[1]) == Approx(0.9));
  CHECK(r.chi_square < 1e-12);
  CHECK(std::abs(r.residual[3]) < 1e-6);
}

TEST_CASE("Refit: without the effect something is left, and a size stays within its bounds", "[diagnosis]") {
  RefitCase c(0.7);
  Evaluator evaluator = c.problem.evaluator(simulator_of(power_laws));
  const RefitProblem problem = c.data({0, 1, 2, 3});
  const Refit baseline = refit(evaluator, problem, unit_start(c.problem.parameters), {}, Eigen::VectorXd(0), 4);
  REQUIRE(baseline.is_usable);
  // weighted least squares of the linear problem
  const Eigen::VectorXd left = c.measured - exponents * exponents.colPivHouseholderQr().solve(c.measured);
  CHECK(baseline.chi_square == Approx(left.squaredNorm() / 0.01).epsilon(1e-6));
  RefitCase negative(-0.7);
  Evaluator other = negative.problem.evaluator(simulator_of(power_laws));
  const Refit r = refit(other, negative.data({0, 1, 2, 3}), unit_start(c.problem.parameters), {free_effect()},
                        Eigen::VectorXd::Zero(1), 4);
  REQUIRE(r.is_usable);
  CHECK(r.sizes[0] == 0.0);
}

TEST_CASE("Refit: a point that cannot be simulated is stepped back from, not taken", "[diagnosis]") {
  RefitCase c(0.7);
  const Simulator broken = failing(simulator_of(power_laws), [](const Eigen::VectorXd& v) { return v[2] > 0.5; });
  Evaluator evaluator = c.problem.evaluator(broken);
  const RefitProblem problem = c.data({0, 1, 2, 3});
  const Refit r = refit(evaluator, problem, unit_start(c.problem.parameters), {free_effect()}, Eigen::VectorXd::Zero(1), 6);
  REQUIRE(r.is_usable);
  CHECK(r.sizes[0] <= 0.5);
  CHECK(r.sizes[0] > 0.2);
  CHECK(std::isfinite(r.chi_square));
}
