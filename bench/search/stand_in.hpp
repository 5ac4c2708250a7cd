// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A fast stand-in of the loamy-sand problem: emulators of stored preview runs, with packing noise; or,
// to check it, the grains themselves.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "calibrate/emulator.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/simulator.hpp"
#include "calibrate/targets.hpp"

namespace tilth::bench {

/// Everything is in T, the transformed feature of a target: ln of stresses and moduli, the friction
/// angle in rad.
///
///   T_k(u, seed) = m_k(u) + packing_sd_k z(seed, k) + chaos_sd_k z(u, seed, k)
///
/// m_k are emulators of runs on one packing, z independent standard normal numbers: the first part
/// is common to all parameter sets on a packing, the second to none. A run fails, as the real ones
/// do, where the soil is so soft that the oedometer runs out of stroke.
struct StandIn {
  std::vector<Parameter> parameters;  ///< the free ones of data/soils/loamy_sand
  std::vector<Target> targets;        ///< its fitted targets, with their sigma
  std::vector<Emulator> emulators;    ///< m_k on the unit cube
  Eigen::VectorXd packing_sd;         ///< from parameter sets run on several packings
  Eigen::VectorXd chaos_sd;           ///< from neighbouring parameter sets on one packing
  std::size_t num_training_runs = 0;
  /// If set, runs are simulated by it (parameters: the free ones, physical, one column per member) and
  /// the emulators only judge.
  std::function<std::vector<Evaluation>(const Eigen::MatrixXd& parameters,
                                        std::span<const std::uint64_t> seeds)>
      grains;
  std::size_t most_simulations = 2000;  ///< of one plain search

  /// m(u). @shape unit (3), result (num_targets)
  Eigen::VectorXd mean(const Eigen::VectorXd& unit) const;
  /// Does a run with this mean fail?
  static bool fails(const Eigen::VectorXd& mean);
  /// Variance of one simulation, both parts.
  Eigen::VectorXd variance() const;
  /// One run. @param stream  tells twins apart: other streams, other packings
  Evaluation run(const Eigen::VectorXd& physical, std::uint64_t seed, std::uint64_t stream) const;
};

/// Trains on a CSV of runs, see bench/reference/README.md.
/// @throws std::runtime_error with every mistake of the file
StandIn read_stand_in(const std::filesystem::path& file);

/// One data set with known parameters.
struct Twin {
  std::uint64_t stream = 0;
  Eigen::VectorXd truth;        ///< unit, inside the middle 70 % of every range
  std::vector<Target> targets;  ///< the data
  double least = 0.0;           ///< of noise_free_chi_square over the box
};

/// Data of twin number `stream`: mean of six packings at a random truth + noise times a normal
/// number; sigma is that noise and the standard error of the six packings, in quadrature.
/// @shape noise (num_targets), in T
Twin make_twin(const StandIn& stand_in, const Eigen::VectorXd& noise, std::uint64_t stream);

Simulator simulator_of(const StandIn& stand_in, const Twin& twin);

/// What a method minimises: chi-square of a mean over num_packings simulations,
/// divided by sigma^2 + variance / num_packings.
Eigen::VectorXd residuals_of(const StandIn& stand_in, const Twin& twin, const Eigen::VectorXd& mean,
                             int num_packings);

/// chi-square of m(u), without noise, in units of what one simulation resolves (num_packings = 1);
/// infinite where runs fail. Used to judge, never shown to a method.
double noise_free_chi_square(const StandIn& stand_in, const Twin& twin,
                             const Eigen::VectorXd& unit);

}  // namespace tilth::bench
