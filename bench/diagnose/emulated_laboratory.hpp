// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The laboratory by emulators of a stored library: what a diagnosis simulates, in milliseconds.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bench/diagnose/library.hpp"
#include "calibrate/cli/diagnosis_case.hpp"
#include "calibrate/emulator.hpp"

namespace tilth::scoreboard {

/// How well the emulators know one statistic.
struct EmulatorQuality {
  std::string statistic;
  double q2 = 0.0;               ///< 1 - leave-one-out squares over squares about the mean
  double root_mean_square = 0.0; ///< of the leave-one-out errors, of T
};

/// T of every statistic over the unit cube of the free parameters.
///
///   m(u) = GP(mean of T over the library's common packings) + (mean over many packings - mean over these, at the nominal values)
///   s_k(u) = GP(secants of the fingerprint rows, packing by packing)
///
/// The offset takes the common packings' own chance out; it is the same everywhere, which is what paired packings do to
/// first order.
class EmulatedLaboratory {
 public:
  explicit EmulatedLaboratory(const Library& library);

  Eigen::VectorXd mean(const Eigen::VectorXd& unit) const;       ///< (p)
  /// m(u) and the effects' fingerprints times their sizes. @shape sizes as candidates
  Eigen::VectorXd mean_with(const Eigen::VectorXd& unit, const std::vector<std::size_t>& candidates,
                            const Eigen::VectorXd& sizes) const;
  /// Everything a diagnosis would have simulated at `unit`, in the order of the case's targets.
  SimulatedEvidence evidence(const SoilCase& soil, const Eigen::VectorXd& unit) const;

  const Library& library() const { return library_; }
  std::vector<EmulatorQuality> quality() const;
  /// Positions of the case's targets among the library's. @throws std::runtime_error if one is not there
  std::vector<Eigen::Index> order_of(const SoilCase& soil) const;

 private:
  void fit_means(const std::vector<Target>& targets);
  void fit_fingerprints(const std::vector<Target>& targets);

  const Library& library_;
  Eigen::VectorXd nominal_;          ///< (q)
  std::vector<Emulator> emulators_;  ///< (p)
  Eigen::VectorXd offset_;           ///< (p)
  Eigen::MatrixXd packings_;         ///< (S, p) T at the nominal values, their mean taken off
  std::vector<std::vector<std::optional<Emulator>>> fingerprints_;  ///< [candidate][statistic]
};

}  // namespace tilth::scoreboard
