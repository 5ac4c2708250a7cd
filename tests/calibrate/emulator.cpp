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
  const Eigen::Index n = 24;
  const Eigen::MatrixXd points = shifted_sobol_points(static_cast<int>(n), 3, 5);
  const Eigen::VectorXd y = values_at(points, 0.1);
  const Emulator emulator(points, y, {});
  // Universal kriging written out, with the same lengths and nugget.
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      k(i, j) = i == j ? 1.0 + emulator.nugget() : 1.0;
      for (Eigen::Index d = 0; d < 3 && i != j; ++d) {
        const double a =
            std::sqrt(5.0) * std::abs(points(d, i) - points(d, j)) / emulator.lengths()[d];
        k(i, j) *= (1.0 + a + a * a / 3.0) * std::exp(-a);
      }
    }
  }
  Eigen::MatrixXd trend(n, 4);
  trend << Eigen::VectorXd::Ones(n), points.transpose();
  const LeaveOneOut closed = emulator.leave_one_out();
  for (Eigen::Index left = 0; left < n; ++left) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i != left) others.push_back(i);
    }
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(k(others, others)).inverse();
    const Eigen::MatrixXd f = trend(others, Eigen::all);
    const Eigen::VectorXd z = y(others);
    const Eigen::VectorXd beta =
        (f.transpose() * inverse * f).inverse() * f.transpose() * inverse * z;
    const Eigen::VectorXd cross = k(others, left);
    const double mean = trend.row(left).dot(beta) + cross.dot(inverse * (z - f * beta));
    // 1e-7: rounding times the condition of K, which the nugget keeps below 1e8.
    REQUIRE(std::abs(closed.residuals[left] - (y[left] - mean)) < 1e-7);
  }
}

TEST_CASE("Emulator: its uncertainty vanishes at the data and grows away from them",
          "[calibrate][emulator]") {
  Eigen::MatrixXd points = 0.5 * shifted_sobol_points(32, 3, 1);  // one corner of the cube
  const Emulator emulator(points, values_at(points, 0.0), {});
  const double at_data = emulator.predict(points.col(3)).variance;
  const double far_away = emulator.predict(Eigen::Vector3d::Ones()).variance;
  REQUIRE(at_data < 1e-2 * far_away);
}
