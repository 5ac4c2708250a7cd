// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_location.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calibrate/diagnosis/small_models.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace tilth;
using namespace tilth::test;

namespace {

// Generalised least squares on some rows: parameters and their covariance.
struct Fit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd sigma;
};

Fit fit_of(const LinearModel& model, const Eigen::VectorXd& r, const Eigen::MatrixXd& v,
           const std::vector<Eigen::Index>& rows) {
  const Eigen::MatrixXd j = model.jacobian(rows, Eigen::all);
  const Eigen::MatrixXd weight = Eigen::MatrixXd(v(rows, rows)).inverse();
  Eigen::MatrixXd information = j.transpose() * weight * j;
  Eigen::VectorXd right = j.transpose() * weight * r(rows);
  for (Eigen::Index k = 0; k < model.prior_precision.size(); ++k) {
    information(k, k) += model.prior_precision[k];
    right[k] += model.prior_precision[k] * model.prior_offset[k];
  }
  const Eigen::MatrixXd sigma = information.inverse();
  return {sigma * right, sigma};
}

struct Setup {
  std::mt19937_64 rng{11};
  LinearModel model = random_model(12, 2, 1, rng);
  Eigen::MatrixXd v = block_covariance(12, rng);
  Eigen::VectorXd r = normal_matrix(12, 1, rng);
};

}  // namespace

TEST_CASE("Location: standardised residuals have the variance that the fit leaves them",
          "[calibrate][diagnosis]") {
  Setup s;
  const bool with_priors = GENERATE(false, true);
  if (with_priors) {
    s.model.prior_precision = Eigen::Vector2d(3.0, 0.0);
    s.model.prior_offset = Eigen::Vector2d(0.4, 0.0);
  }
  std::vector<Eigen::Index> all(12);
  for (Eigen::Index i = 0; i < 12; ++i) all[static_cast<std::size_t>(i)] = i;
  const Fit fit = fit_of(s.model, s.r, s.v, all);
  const Eigen::VectorXd rest = s.r - s.model.jacobian * fit.theta;
  const Eigen::MatrixXd left = s.v - s.model.jacobian * fit.sigma * s.model.jacobian.transpose();
  const Eigen::VectorXd found = standardised_residuals(s.model, s.r, s.v);
  for (Eigen::Index i = 0; i < 12; ++i)
    REQUIRE_THAT(found[i], WithinAbs(rest[i] / std::sqrt(left(i, i)), 1e-9));
}

TEST_CASE("Location: a statistic the fit is forced through is not called good",
          "[calibrate][diagnosis]") {
  Setup s;
  s.model.jacobian.col(1).setZero();
  s.model.jacobian(4, 1) = 1.0;  // a parameter of its own
  const Eigen::VectorXd found =
      standardised_residuals(s.model, s.r, Eigen::MatrixXd::Identity(12, 12));
  REQUIRE(std::isnan(found[4]));
  REQUIRE((found.array().isFinite()).count() == 11);
}

TEST_CASE("Location: the experiment left out is compared with its prediction by the others",
          "[calibrate][diagnosis]") {
  Setup s;
  const bool with_priors = GENERATE(false, true);
  if (with_priors) {
    s.model.prior_precision = Eigen::Vector2d(3.0, 0.5);
    s.model.prior_offset = Eigen::Vector2d(0.4, -0.2);
  }
  const auto found = left_out_experiments(s.model, s.r, s.v);
  REQUIRE(found.size() == 4);
  for (const LeftOutExperiment& e : found) {
    const std::vector<Eigen::Index> rows = rows_of(s.model, e.experiment);
    const Fit others = fit_of(s.model, s.r, s.v, rows_of(s.model, e.experiment, true));
    const Eigen::MatrixXd j = s.model.jacobian(rows, Eigen::all);
    const Eigen::VectorXd d = s.r(rows) - j * others.theta;
    const Eigen::MatrixXd c = s.v(rows, rows) + j * others.sigma * j.transpose();
    REQUIRE_THAT(e.statistic, WithinRel(d.dot(c.inverse() * d), 1e-9));
    REQUIRE(e.freedom == 3.0);
  }
}

TEST_CASE("Location: an experiment with a parameter of its own is tested on the rest",
          "[calibrate][diagnosis]") {
  Setup s;
  s.model.jacobian.col(1).setZero();
  s.model.jacobian(2, 1) = 1.0;  // in experiment a alone
  REQUIRE(left_out_experiments(s.model, s.r, s.v).front().freedom == 2.0);
}

TEST_CASE("Location: tug-of-war is the distance of two fits in their own errors",
          "[calibrate][diagnosis]") {
  Setup s;
  // The joint fit's priors take no part: each experiment speaks for itself.
  s.model.prior_precision = Eigen::Vector2d(30.0, 30.0);
  s.model.prior_offset = Eigen::Vector2d(5.0, 5.0);
  LinearModel alone = s.model;
  alone.prior_precision.resize(0);
  for (const TugOfWar& tug : tugs_of_war(s.model, s.r, s.v)) {
    const Fit a = fit_of(alone, s.r, s.v, rows_of(s.model, tug.first));
    const Fit b = fit_of(alone, s.r, s.v, rows_of(s.model, tug.second));
    const Eigen::VectorXd d = a.theta - b.theta;
    REQUIRE_THAT(tug.statistic, WithinRel(d.dot((a.sigma + b.sigma).inverse() * d), 1e-8));
    REQUIRE(tug.freedom == 2.0);
  }
}

TEST_CASE("Location: what one experiment wants of one parameter, the others held",
          "[calibrate][diagnosis]") {
  Setup s;
  s.model.jacobian(Eigen::seq(3, 5), 1).setZero();  // experiment b does not know parameter 1
  s.v.setIdentity();
  s.r.setZero();
  // Experiment a alone asks for one more unit of parameter 0.
  s.r.head(3) = s.model.jacobian.col(0).head(3);
  const auto wishes = parameter_wishes(s.model, s.r, s.v);
  const Fit joint = fit_of(s.model, s.r, s.v, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const Eigen::VectorXd j = s.model.jacobian.col(0).head(3);
  const Eigen::VectorXd rest = (s.r - s.model.jacobian * joint.theta).head(3);
  REQUIRE_THAT(wishes[0].change, WithinRel(j.dot(rest) / j.squaredNorm(), 1e-10));
  REQUIRE_THAT(wishes[0].standard_error, WithinRel(1.0 / j.norm(), 1e-12));
  REQUIRE(wishes[0].change > 0.0);
  REQUIRE(wishes[3].experiment == "b");
  REQUIRE(wishes[3].parameter == 1);
  REQUIRE(std::isinf(wishes[3].standard_error));
  REQUIRE(wishes[3].change == 0.0);
}
