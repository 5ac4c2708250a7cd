// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Simulators made of formulas, with packing noise and failures that can be ordered.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "calibrate/parameters.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth::test {

using Formula = std::function<Eigen::VectorXd(const Eigen::VectorXd& parameters)>;

/// A scrambled 64-bit word (SplitMix64, Steele, Lea & Flood 2014).
inline std::uint64_t scrambled(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

/// One standard normal number per (stream, seed, index), by Box and Muller.
inline double normal_number(std::uint64_t stream, std::uint64_t seed, std::uint64_t index) {
  const std::uint64_t word = scrambled(scrambled(scrambled(stream) ^ seed) ^ index);
  const double u = (static_cast<double>(word >> 11) + 0.5) * 0x1p-53;
  const double v = static_cast<double>(scrambled(word) >> 11) * 0x1p-53;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

/// Completed runs of a formula. A packing multiplies feature k by exp(noise * normal number): the
/// same for all parameter sets on that seed, as a packing does.
inline Simulator simulator_of(Formula formula, double noise = 0.0, std::uint64_t stream = 0) {
  return [=](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<Evaluation> runs;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      const std::uint64_t seed = seeds[static_cast<std::size_t>(i)];
      Eigen::VectorXd features = formula(parameters.col(i));
      for (Eigen::Index k = 0; noise > 0.0 && k < features.size(); ++k) {
        features[k] *= std::exp(noise * normal_number(stream, seed, static_cast<std::uint64_t>(k)));
      }
      runs.push_back({EvaluationStatus::completed, features, ""});
    }
    return runs;
  };
}

/// The same, but runs for which `fails` says yes are failed.
inline Simulator failing(Simulator inner, std::function<bool(const Eigen::VectorXd&)> fails) {
  return [=](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<Evaluation> runs = inner(parameters, seeds);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!fails(parameters.col(static_cast<Eigen::Index>(i)))) continue;
      runs[i] = {EvaluationStatus::failed, {}, "the packing exploded"};
    }
    return runs;
  };
}

inline Parameter log_parameter(const std::string& name, double lower, double upper, double start) {
  Parameter p;
  p.name = name;
  p.lower = lower;
  p.upper = upper;
  p.start = start;
  p.log_scale = true;
  return p;
}

inline Parameter linear_parameter(const std::string& name, double lower, double upper,
                                  double start) {
  Parameter p = log_parameter(name, lower, upper, start);
  p.log_scale = false;
  return p;
}

/// A target on a log scale: sigma is relative.
inline Target log_target(const std::string& name, double value, double sigma) {
  Target t;
  t.name = name;
  t.value = value;
  t.sigma = sigma;
  t.log_transform = true;
  return t;
}

/// Three parameters, six positive features, mildly curved in the logarithms.
inline Eigen::VectorXd soil_formula(const Eigen::VectorXd& p) {
  const double modulus = p[0];
  const double strength = p[1];
  const double friction = p[2];
  Eigen::VectorXd f(6);
  f << modulus * std::pow(1.0 + friction, 0.3),  // stiffness
      strength * (1.0 + 0.8 * friction),         // peak stress
      strength / modulus * 1e3,                  // strain at peak
      0.2 + friction,                            // friction coefficient
      std::sqrt(modulus * strength),             // energy
      strength * std::exp(0.5 * friction) / (1.0 + 0.01 * modulus / strength);
  return f;
}

inline std::vector<Parameter> soil_parameters() {
  return {log_parameter("modulus_Pa", 1e6, 1e8, 5e6), log_parameter("strength_Pa", 1e3, 1e5, 2e4),
          log_parameter("friction", 0.1, 1.5, 0.8)};
}

inline Eigen::VectorXd soil_truth() { return Eigen::Vector3d(1.6e7, 8e3, 0.45); }

/// Targets at the truth, each moved by sigma times a normal number of this stream (0 = not moved).
inline std::vector<Target> soil_targets(double sigma, std::uint64_t stream) {
  const Eigen::VectorXd truth = soil_formula(soil_truth());
  std::vector<Target> targets;
  for (Eigen::Index k = 0; k < truth.size(); ++k) {
    const auto index = static_cast<std::uint64_t>(k);
    const double error = stream == 0 ? 0.0 : sigma * normal_number(stream, 77, index);
    targets.push_back(
        log_target("feature_" + std::to_string(k), truth[k] * std::exp(error), sigma));
  }
  return targets;
}

}  // namespace tilth::test
