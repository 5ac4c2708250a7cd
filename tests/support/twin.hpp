// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Twin experiments with the grains themselves: data from known parameters, then an ordinary fit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/fit.hpp"

namespace tilth::test {

/// What the fit has to find; the tied and the fixed parameters are those of data/soils/loamy_sand.
struct TwinTruth {
  double bond_modulus_Pa = 0.0;
  double bond_tensile_strength_Pa = 0.0;
  double friction = 0.0;
};

struct TwinSpec {
  TwinTruth truth;
  Fidelity data = Fidelity::preview;     ///< specimens of the data ...
  Fidelity search = Fidelity::preview;   ///< ... and of the fit
  std::optional<Fidelity> confirm = {};  ///< needed where the data are of another size
  double relative_noise = 0.05;          ///< of stresses and moduli
  double angle_noise_rad = 0.02618;      ///< of the friction angle: 1.5 deg
  bool line = false;                     ///< cohesion and friction angle instead of two peaks
  int num_data_packings = 6;             ///< on seeds that no stage of a fit uses
  std::uint64_t noise_stream = 1;
  FitOptions options;
};

/// One parameter after the fit.
struct TwinParameter {
  std::string name;
  double truth = 0.0, value = 0.0, lo95 = 0.0, hi95 = 0.0;
  bool inside = false;
};

struct TwinResult {
  FitSummary summary;
  std::vector<TwinParameter> parameters;  ///< the free ones
  int num_inside = 0;
};

/// A soil whose targets are the mean of num_data_packings specimens plus noise, with the sigma a
/// laboratory would state: noise and standard error of that mean, in quadrature.
SoilData twin_soil(const TwinSpec& spec, const RunContext& context);

/// Fits twin_soil() with the ordinary pipeline.
TwinResult run_twin(const TwinSpec& spec, const RunContext& context);

/// The twins of docs/twins.md.
struct TwinCase {
  std::string name;
  TwinSpec spec;
};
std::vector<TwinCase> documented_twins();

/// Rows of a Markdown table: truth, value, interval, inside; the last row says how well it fits.
std::string twin_table(const std::string& name, const TwinResult& result);

/// x with P(chi-square of `freedom` <= x) = share, after Wilson and Hilferty (1931).
/// @param normal_quantile of the same share: 2.326 for 99 %, -2.326 for 1 %, 3.090 for 99.9 %
double chi_square_quantile(double normal_quantile, int freedom);

}  // namespace tilth::test
