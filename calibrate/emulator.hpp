// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A cheap stand-in for one feature of the simulator: a Gaussian process on the unit cube.
#pragma once

#include <Eigen/Core>

namespace tilth {

enum class EmulatorKernel { matern52, squared_exponential };
enum class EmulatorTrend { linear, quadratic };

struct EmulatorOptions {
  EmulatorKernel kernel = EmulatorKernel::matern52;
  EmulatorTrend trend = EmulatorTrend::linear;
  int max_evaluations = 300;  ///< of the likelihood, per start of its search
};

/// Fewest points an emulator can be made of: trend terms + 2.
Eigen::Index min_emulator_points(EmulatorTrend trend, Eigen::Index num_dimensions);

struct EmulatorPrediction {
  double mean = 0.0;
  double variance = 0.0;  ///< of the noise-free function, trend uncertainty included; >= 0
};

struct LeaveOneOut {
  Eigen::VectorXd residuals;            ///< y_i - mean predicted without point i
  Eigen::VectorXd standard_deviations;  ///< of that prediction, nugget included
  double q2 = 0.0;                      ///< 1 - sum residuals^2 / sum (y - mean y)^2
};

/// y(u) = f(u)' beta + Z(u) + noise, Z of zero mean and covariance s^2 R.
///
///   matern52:            R = prod_j (1 + a_j + a_j^2 / 3) e^{-a_j},  a_j = sqrt(5) |du_j| / l_j
///   squared_exponential: R = prod_j e^{-(du_j / l_j)^2 / 2}
///   f = 1, u_1 .. u_d  (quadratic: and all products u_i u_j, i <= j);  noise variance g s^2
///
/// beta by generalised least squares, s^2 = (y - F beta)' K^-1 (y - F beta) / (n - p), and
/// (l_1 .. l_d, g) by maximum restricted likelihood, minimising
///   (n - p) ln s^2 + ln|K| + ln|F' K^-1 F|,   K = R + g I,
/// with Sbplx from two fixed starts: deterministic. Lengths in [0.05, 20], g in [1e-8, 1].
/// @source Rasmussen & Williams 2006, eqs 2.37-2.45 and 4.17; leave-one-out Dubrule 1983
class Emulator {
 public:
  /// @shape points (num_dimensions, n), in the unit cube; values (n), finite
  /// @pre n >= min_emulator_points()
  /// @cost O(n^3) per likelihood evaluation
  Emulator(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
           const EmulatorOptions& options);

  EmulatorPrediction predict(const Eigen::VectorXd& point) const;  ///< O(n^2)
  double predict_mean(const Eigen::VectorXd& point) const;         ///< the mean alone, O(n)
  /// f(high) - f(low): neighbours are known together, so its variance is far below the sum of theirs.
  EmulatorPrediction predict_difference(const Eigen::VectorXd& high, const Eigen::VectorXd& low) const;
  LeaveOneOut leave_one_out() const;

  const Eigen::VectorXd& lengths() const { return lengths_; }
  double nugget() const { return nugget_; }

 private:
  // Everything that follows from the lengths and the nugget.
  struct Solution {
    Eigen::MatrixXd lower;         // L, K = L L'
    Eigen::MatrixXd white_trend;   // L^-1 F
    Eigen::MatrixXd trend_factor;  // upper R of L^-1 F = Q R
    Eigen::VectorXd beta;
    Eigen::VectorXd weights;  // K^-1 (y - F beta)
    double variance = 0.0;    // s^2
    double objective = 0.0;   // what the likelihood search minimises; infinite if K is singular
  };

  Eigen::VectorXd trend_terms(const Eigen::VectorXd& point) const;
  /// Of the combination of values with correlations r to the data, trend f and prior variance s^2 prior.
  EmulatorPrediction predict(const Eigen::VectorXd& r, const Eigen::VectorXd& f, double prior) const;
  Eigen::VectorXd correlations(const Eigen::VectorXd& point, const Eigen::VectorXd& lengths) const;
  Solution solve(const Eigen::VectorXd& lengths, double nugget) const;
  void choose_hyperparameters();

  EmulatorOptions options_;
  Eigen::MatrixXd points_;
  Eigen::VectorXd values_;  // scaled to mean 0, standard deviation 1
  double offset_ = 0.0;
  double scale_ = 1.0;
  Eigen::MatrixXd trend_;  // F (n, p)
  Eigen::VectorXd lengths_;
  double nugget_ = 0.0;
  Solution solution_;
};

}  // namespace tilth
