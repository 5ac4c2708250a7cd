// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Small linear models for tests of the diagnosis.
#pragma once

#include <Eigen/Core>
#include <random>
#include <string>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/verdict.hpp"

namespace tilth::test {

inline Eigen::MatrixXd normal_matrix(Eigen::Index rows, Eigen::Index cols, std::mt19937_64& rng) {
  Eigen::MatrixXd x(rows, cols);
  for (double& number : x.reshaped()) number = standard_normal(rng);
  return x;
}

/// p statistics in experiments of three ("a", "b", ...), q parameters, K effects, random numbers.
inline LinearModel random_model(Eigen::Index p, Eigen::Index q, Eigen::Index num_effects,
                                std::mt19937_64& rng) {
  LinearModel model;
  for (Eigen::Index i = 0; i < p; ++i)
    model.statistics.push_back({std::string(1, static_cast<char>('a' + i / 3)), std::to_string(i)});
  model.jacobian = normal_matrix(p, q, rng);
  model.fingerprints = normal_matrix(p, num_effects, rng);
  return model;
}

/// Positive definite, zero between the experiments of random_model().
inline Eigen::MatrixXd block_covariance(Eigen::Index p, std::mt19937_64& rng) {
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(p, p);
  for (Eigen::Index i = 0; i < p; i += 3) {
    const Eigen::Index m = std::min<Eigen::Index>(3, p - i);
    const Eigen::MatrixXd half = normal_matrix(m, m, rng);
    v.block(i, i, m, m) = half * half.transpose() + Eigen::MatrixXd::Identity(m, m);
  }
  return v;
}

/// Candidates "e0", "e1", ... of typical size 1.
inline std::vector<CandidateEffect> unit_candidates(Eigen::Index num,
                                                    EffectSign sign = EffectSign::positive) {
  std::vector<CandidateEffect> candidates;
  for (Eigen::Index k = 0; k < num; ++k)
    candidates.push_back({"e" + std::to_string(k), sign, 1.0, 1.0, false});
  return candidates;
}

/// A soil whose residual is `residual` exactly and whose V is the identity: one specimen, one
/// packing, every statistic a test of its own.
inline SoilEvidence identity_soil(const LinearModel& model, const Eigen::VectorXd& residual,
                                  const std::vector<CandidateEffect>& candidates) {
  SoilEvidence soil;
  soil.soil = "made up";
  soil.model = model;
  soil.candidates = candidates;
  const Eigen::Index p = residual.size();
  soil.noise.replicate_variances = Eigen::VectorXd::Constant(p, 1.0 - 1e-9);
  soil.noise.packing_variances = Eigen::VectorXd::Constant(p, 1e-9);
  for (Eigen::Index i = 0; i < p; ++i)
    soil.samples.push_back({{i}, residual.segment(i, 1), Eigen::MatrixXd::Zero(1, 1)});
  return soil;
}

}  // namespace tilth::test
