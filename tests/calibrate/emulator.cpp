// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/emulator.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "calibrate/sobol_design.hpp"
#include "tests/calibrate/formula_models.hpp"

using namespace tilth;
using namespace tilth::test;

namespace {

// Smooth, with a trend, and almost blind to its third input.
double smooth(const Eigen::VectorXd& u) {
  return 3.0 + 2.0 * u[0] + std::sin(4.0 * u[0]) * std::cos(2.0 * u[1]) + 0.05 * u[2] * u[2];
}

Eigen::VectorXd values_at(const Eigen::MatrixXd& points, double noise) {
  Eigen::VectorXd values(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    values[i] = smooth(points.col(i)) + noise * normal_number(9, 9, static_cast<std::uint64_t>(i));
  }
  return values;
}

double rms_error(const Emulator& emulator) {
  const Eigen::MatrixXd fresh = shifted_sobol_points(256, 3, 99);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < fresh.cols(); ++i) {
    sum += std::pow(emulator.predict_mean(fresh.col(i)) - smooth(fresh.col(i)), 2);
  }
  return std::sqrt(sum / static_cast<double>(fresh.cols()));
}

// Universal kriging with the emulator's lengths and nugget, by plain inverses.
struct WrittenOut {
  double mean;
  double share;  // variance / s^2
};

WrittenOut written_out(const Emulator& emulator, const Eigen::MatrixXd& points,
                       const Eigen::VectorXd& y, const Eigen::VectorXd& at) {
  const auto matern = [&](const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
    double product = 1.0;
    for (Eigen::Index d = 0; d < u.size(); ++d) {
      const double a = std::sqrt(5.0) * std::abs(u[d] - v[d]) / emulator.lengths()[d];
      product *= (1.0 + a + a * a / 3.0) * std::exp(-a);
    }
    return product;
  };
  const Eigen::Index n = points.cols();
  Eigen::MatrixXd k(n, n);
  Eigen::VectorXd cross(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) k(i, j) = matern(points.col(i), points.col(j));
    k(i, i) += emulator.nugget();
    cross[i] = matern(points.col(i), at);
  }
  Eigen::MatrixXd f(n, 1 + at.size());
  f << Eigen::VectorXd::Ones(n), points.transpose();
  Eigen::VectorXd f_at(1 + at.size());
  f_at << 1.0, at;
  const Eigen::MatrixXd inverse = k.inverse();
  const Eigen::MatrixXd trend_covariance = (f.transpose() * inverse * f).inverse();
  const Eigen::VectorXd beta = trend_covariance * f.transpose() * inverse * y;
  const Eigen::VectorXd h = f_at - f.transpose() * inverse * cross;
  return {f_at.dot(beta) + cross.dot(inverse * (y - f * beta)),
          1.0 - cross.dot(inverse * cross) + h.dot(trend_covariance * h)};
}

}  // namespace

TEST_CASE("Emulator: exact data are interpolated and new points predicted",
          "[calibrate][emulator]") {
  const Eigen::MatrixXd points = shifted_sobol_points(48, 3, 1);
  for (const EmulatorKernel kernel :
       {EmulatorKernel::matern52, EmulatorKernel::squared_exponential}) {
    for (const EmulatorTrend trend : {EmulatorTrend::linear, EmulatorTrend::quadratic}) {
      const Emulator emulator(points, values_at(points, 0.0), {kernel, trend, 300});
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const EmulatorPrediction at = emulator.predict(points.col(i));
        // 1e-3 of a range of 3: the nugget is small but not zero.
        REQUIRE(std::abs(at.mean - smooth(points.col(i))) < 3e-3);
        // Both paths do the same sums: rounding.
        REQUIRE(std::abs(at.mean - emulator.predict_mean(points.col(i))) < 1e-10);
      }
      // 2 % of the standard deviation (0.7) of the function.
      REQUIRE(rms_error(emulator) < 0.015);
      REQUIRE(emulator.leave_one_out().q2 > 0.99);
    }
  }
}

TEST_CASE("Emulator: an input without influence gets the longest length", "[calibrate][emulator]") {
  const Eigen::MatrixXd points = shifted_sobol_points(48, 3, 1);
  const Emulator emulator(points, values_at(points, 0.0), {});
  REQUIRE(emulator.lengths()[2] > 2.0 * emulator.lengths()[0]);
}

TEST_CASE("Emulator: noise goes to the nugget, not to the curve", "[calibrate][emulator]") {
  const double noise = 0.1;
  const Eigen::MatrixXd points = shifted_sobol_points(96, 3, 1);
  const Emulator emulator(points, values_at(points, noise), {});
  // The curve averages noise: nearer to the truth than any single value.
  REQUIRE(rms_error(emulator) < noise);
  const LeaveOneOut left = emulator.leave_one_out();
  const Eigen::ArrayXd standard = left.residuals.array() / left.standard_deviations.array();
  // 96 nearly normal numbers: mean square 1 +/- 4 sqrt(2 / 96) = 0.58.
  REQUIRE(std::abs(standard.square().mean() - 1.0) < 0.58);
}

TEST_CASE("Emulator: the closed leave-one-out equals leaving one out", "[calibrate][emulator]") {
  const Eigen::MatrixXd points = shifted_sobol_points(24, 3, 5);
  const Eigen::VectorXd y = values_at(points, 0.1);
  const Emulator emulator(points, y, {});
  const LeaveOneOut closed = emulator.leave_one_out();
  std::vector<double> scale;  // what should be the same s^2 for every point
  for (Eigen::Index left = 0; left < points.cols(); ++left) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (i != left) others.push_back(i);
    }
    const WrittenOut without =
        written_out(emulator, points(Eigen::all, others), y(others), points.col(left));
    // 1e-7: rounding times the condition of K, which the nugget keeps below 1e8.
    REQUIRE(std::abs(closed.residuals[left] - (y[left] - without.mean)) < 1e-7);
    scale.push_back(std::pow(closed.standard_deviations[left], 2) /
                    (without.share + emulator.nugget()));
    REQUIRE(std::abs(scale.back() / scale.front() - 1.0) < 1e-6);  // as above
  }
}

TEST_CASE("Emulator: a prediction is universal kriging written out", "[calibrate][emulator]") {
  const Eigen::MatrixXd points = shifted_sobol_points(12, 3, 5);
  const Eigen::VectorXd y = values_at(points, 0.1);
  const Emulator emulator(points, y, {});
  const Eigen::Vector3d here(0.4, 0.5, 0.6);
  const Eigen::Vector3d corner(1.0, 0.0, 1.0);  // where the trend is least known
  const WrittenOut at_here = written_out(emulator, points, y, here);
  const WrittenOut at_corner = written_out(emulator, points, y, corner);
  // 1e-7 as above; a ratio of variances, because s^2 is private.
  REQUIRE(std::abs(emulator.predict(corner).mean - at_corner.mean) < 1e-7);
  REQUIRE(std::abs(emulator.predict(corner).variance / emulator.predict(here).variance -
                   at_corner.share / at_here.share) < 1e-6 * at_corner.share / at_here.share);
}

TEST_CASE("Emulator: a difference is known better than its ends", "[calibrate][emulator]") {
  const Eigen::MatrixXd points = shifted_sobol_points(12, 3, 5);
  const Emulator emulator(points, values_at(points, 0.0), {});
  const Eigen::Vector3d a(0.4, 0.5, 0.6), near(0.42, 0.5, 0.6);
  const EmulatorPrediction d = emulator.predict_difference(near, a);
  CHECK(d.mean == Approx(emulator.predict_mean(near) - emulator.predict_mean(a)));
  CHECK(emulator.predict_difference(a, a).variance < 1e-12);
  // the other end is a data point without noise: the variance is that of the one
  const Eigen::VectorXd data = points.col(3);
  CHECK(emulator.predict_difference(a, data).variance == Approx(emulator.predict(a).variance).epsilon(1e-3));
  CHECK(d.variance < 0.1 * (emulator.predict(near).variance + emulator.predict(a).variance));
}

TEST_CASE("Emulator: its uncertainty vanishes at the data and grows away from them",
          "[calibrate][emulator]") {
  Eigen::MatrixXd points = 0.5 * shifted_sobol_points(32, 3, 1);  // one corner of the cube
  const Emulator emulator(points, values_at(points, 0.0), {});
  const double at_data = emulator.predict(points.col(3)).variance;
  const double far_away = emulator.predict(Eigen::Vector3d::Ones()).variance;
  REQUIRE(at_data < 1e-2 * far_away);
}
