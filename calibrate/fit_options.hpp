// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// How a fit is run: every stage's size and stopping rule, in units of simulations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "calibrate/evaluator.hpp"

namespace tilth {

struct Gate;

/// How the local search takes derivatives.
enum class DerivativeRule {
  secants,       ///< one wide step per parameter: for simulators with noise
  extrapolated,  ///< extrapolated to step zero, sixteen runs per parameter: smooth and noise-free
};

/// On what profile likelihoods are drawn.
enum class ProfileSource {
  none,
  emulators,  ///< of the search runs: costs no simulation; none if there are too few runs
  simulator,  ///< the search simulator on the search seeds: for cheap ones
};

/// One simulation is one parameter set on one seed. Seeds are consecutive numbers, so that
/// packings can be named and kept: search and noise use seed, seed + 1, ...; the confirming
/// simulator seed + 1000, ...; the fresh seeds at the end seed + 2000, ...
struct FitOptions {
  std::uint64_t seed = 1;
  int num_design = 32;        ///< Sobol points beside the start values; 0 = start values only
  int num_noise_seeds = 6;    ///< repeats at the best design point; < 2 = no seed noise assumed
  int num_search_seeds = 3;   ///< packings averaged in the local stage
  int num_confirm_seeds = 4;  ///< runs of the confirming simulator per bias round
  int num_fresh_seeds = 4;    ///< runs at the end on seeds no stage has used; 0 = none
  int num_rounds = 3;         ///< emulator rounds; 0 = no emulator
  int round_size = 6;         ///< real runs per emulator round
  int num_starts = 2;         ///< local searches from the best real points
  int max_iterations = 10;    ///< of one local search
  int max_bias_rounds = 2;    ///< bias, refit, bias, refit
  /// A local search has converged when an iteration lowers chi-square by less than this times the
  /// reduced chi-square (at least 1) of the best point before it. 0.01 is
  /// a tenth of a standard error at most.
  double chi_square_tolerance = 0.01;  ///< 0 = off
  double function_tolerance = 1e-6;   ///< ... or when it changes chi-square by less than this share
  double parameter_tolerance = 1e-5;  ///< ... or by a step below this share of the unit cube
  /// ... or, with secants, by a step below this share of their half-width: the noise of single runs
  /// lets no secant judge a step so much shorter than itself.
  double secant_tolerance = 0.05;
  double gradient_tolerance = 1e-10;  ///< ... or when no slope of chi-square / 2 is larger
  DerivativeRule derivatives = DerivativeRule::secants;
  /// Half-width of a central secant where the parameter states none: in ln v if log_scale ...
  /// Peaks of whole shear curves are chaotic even on a fixed packing: 15 % steps raise the signal
  /// threefold over 5 % ones while the response stays nearly straight.
  double log_step = 0.15;
  /// ... else as a share of upper - lower.
  double linear_step = 0.08;
  std::size_t max_simulations = 2000;
  /// The sigma of the targets are known up to a common factor only: standard errors are multiplied
  /// by sqrt(reduced chi-square) and intervals use Student's t. Needs more observations than free
  /// parameters. False: sigma is absolute.
  bool rescale_sigma = false;
  ProfileSource profiles = ProfileSource::emulators;
  double holdout_limit = 2.0;  ///< pass mark: root mean square of the hold-out residuals
  bool force = false;          ///< fit even if there are more free parameters than observations
  std::function<bool()> should_stop;              ///< asked before every batch; may be empty
  std::function<void(const Progress&)> progress;  ///< called after every batch; may be empty
  std::function<void(const Gate&)> report_gate;   ///< called for each before the search; may be empty
};

/// A preset for a first look: fewer points, one packing, one start. Same stages, wider intervals.
FitOptions quick_fit_options();

/// A preset for cheap simulators that are smooth and free of noise (formulas, regression): one local
/// search from the start values to rounding error, no design, no seeds, profiles on the simulator.
FitOptions smooth_fit_options();

/// Everything wrong with the options, one sentence each; empty if they may be used.
std::vector<std::string> problems(const FitOptions& options);

/// What a stage will ask of which simulator, assuming six iterations per local search.
struct PlannedStage {
  std::string stage;
  std::string simulator;  ///< "search", "confirm" or "hold-outs"
  std::size_t num_simulations = 0;
};
std::vector<PlannedStage> planned_stages(const FitOptions& options, std::size_t num_free,
                                         bool has_confirm, bool has_holdout);

/// Simulations a fit will take without hold-outs of their own; an estimate for progress bars, never
/// more than max_simulations.
std::size_t expected_simulations(const FitOptions& options, std::size_t num_free, bool has_confirm);

}  // namespace tilth
