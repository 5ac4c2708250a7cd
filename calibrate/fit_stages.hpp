// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Private to fit(): the state its stages share, and the stages themselves.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibrate/emulator.hpp"
#include "calibrate/evaluator.hpp"
#include "calibrate/fit_options.hpp"
#include "calibrate/fit_summary.hpp"
#include "calibrate/optimise_ceres.hpp"
#include "calibrate/parameters.hpp"
#include "calibrate/profile.hpp"
#include "calibrate/secants.hpp"
#include "calibrate/targets.hpp"
#include "calibrate/uncertainty.hpp"

namespace tilth {

/// A point simulated on the first search seed.
struct KnownPoint {
  Eigen::VectorXd unit;                     ///< (num_free)
  std::optional<Eigen::VectorXd> features;  ///< T, all targets; empty if the run failed
};

/// The best point so far, on num_seeds packings.
struct Optimum {
  Eigen::VectorXd unit;  ///< (num_free)
  Eigen::VectorXd mean;  ///< T, all targets, without bias
  int num_seeds = 1;
  double chi_square = not_known;
  bool from_local_search = false;  ///< else a point of the design or of a search round
  bool converged = false;
};

/// "T" marks quantities of the transformed value; vectors over targets have all of them, hold-outs
/// included, in table order.
struct FitContext {
  const std::vector<Parameter>& parameters;
  const std::vector<Target>& targets;
  const FitOptions& options;
  std::vector<std::size_t> free;    ///< positions of the free parameters
  std::vector<std::size_t> fitted;  ///< positions of the fitted targets
  SimulationLedger& ledger;
  Evaluator search;
  std::optional<Evaluator> confirm;
  std::optional<Evaluator> holdout;
  FitSummary summary{};

  std::vector<KnownPoint> points{};    ///< start first, then design, then search rounds
  Eigen::VectorXd seed_variance{};     ///< T, one search simulation
  Eigen::VectorXd confirm_variance{};  ///< T, one confirming simulation
  Eigen::MatrixXd seed_correlation{};  ///< of the fitted targets
  Eigen::VectorXd bias{};              ///< T, mean confirm - mean search
  Eigen::VectorXd bias_error{};        ///< T; NaN while there is no bias
  int num_bias_seeds = 0;              ///< completed confirming runs behind bias; 0 = none
  std::optional<Optimum> optimum{};
  std::optional<Secants> secants{};                ///< at the optimum
  /// Secants::second_differences of every point of a local search, of secants that were not widened.
  std::map<std::vector<double>, Eigen::MatrixXd> second_differences{};
  Eigen::VectorXi secant_doublings{};  ///< (num_free), of the next secants on the search packings
  std::optional<LinearUncertainty> uncertainty{};  ///< at the optimum
  std::optional<std::vector<Emulator>> emulators{};  ///< of all search runs, see final_emulators()
  std::vector<Profile> profiles{};                 ///< of the free parameters, or empty
  double least_profile = not_known;                ///< the least chi-square of all profile points
};

/// num consecutive seeds of a stage, see FitOptions.
enum class SeedUse { search = 0, confirm = 1000, fresh = 2000 };
std::vector<std::uint64_t> stage_seeds(const FitOptions& options, SeedUse use, int num);

// fit_derivatives.cpp
/// Features and their derivatives at a point by the rule of the options, see Secants.
std::optional<Secants> derivatives_at(const FitContext& context, Evaluator& evaluator,
                                      const Eigen::VectorXd& unit,
                                      std::span<const std::uint64_t> seeds);
/// Derivatives on the search packings. With secants, those of parameters whose derivatives are noise to
/// more than a tenth of their square are doubled, at most twice and to a quarter of the range, and halved
/// again for the next point where the narrower ones would do.
std::optional<Secants> search_derivatives_at(FitContext& context, const Eigen::VectorXd& unit);
/// What the noise of the runs alone adds to J'J of residual_jacobian() for these secants, (num_free, num_free):
///   sum_k v_k noise_shape / sigma_total_k^2,   v_k = median of d_k^2 / 6 / 0.455
/// over all second differences d of the local searches that were not widened. A response that bends over
/// its secants counts as noise, hence the median. Empty for extrapolated derivatives.
Eigen::MatrixXd noise_in_products(const FitContext& context, const Secants& secants);
/// Singular values below this share of the largest drown in the error of the derivatives.
double derivative_error_share(const FitOptions& options);

// fit_residuals.cpp
/// What sigma is multiplied by: 1, or sqrt(reduced chi-square of the optimum) with rescale_sigma.
/// NaN if that is asked for without degrees of freedom.
double sigma_scale(const FitContext& context);
/// See FitSummary::r_squared. @pre optimum exists
double r_squared(const FitContext& context);
/// Observations and priors minus free parameters.
int degrees_of_freedom(const FitContext& context);
/// Variance of T of the model's mean over num_seeds packings, per target: v / num_seeds; once
/// the bias is known that of the confirming mean, because the search packings it was measured on
/// cancel in search + bias.
Eigen::VectorXd model_variance(const FitContext& context, int num_seeds);
/// sigma_total of the fitted targets. @shape (num_fitted)
Eigen::VectorXd fitted_sigmas(const FitContext& context, int num_seeds);
/// Fitted targets, then priors of free parameters. Hold-outs are not in it.
Eigen::VectorXd fit_residuals(const FitContext& context, const Eigen::VectorXd& unit,
                              const Eigen::VectorXd& mean, int num_seeds);
/// d fit_residuals / d unit from d mean / d unit (all targets).
Eigen::MatrixXd residual_jacobian(const FitContext& context,
                                  const Eigen::MatrixXd& feature_jacobian, int num_seeds);
/// Number of priors on free parameters.
std::size_t num_priors(const FitContext& context);
/// Books chi-square in the history.
void record_cost(FitContext& context, double chi_square);

// fit_stage_conflicts.cpp
/// Pairs of fitted targets that the model can meet alone but not together: no point of the parameter
/// box brings both within conflict_limit sigma_total, on the emulators of all search runs.
///   misfit = min over u of max(|r_a(u)|, |r_b(u)|)
void find_conflicts(FitContext& context);

// fit_stage_search.cpp
/// One emulator per fitted target on the points completed so far; empty with too few of them.
std::vector<Emulator> make_emulators(const FitContext& context);

/// The same when the search is over, made once.
const std::vector<Emulator>& final_emulators(FitContext& context);

// fit_stage_design.cpp
void run_design(FitContext& context);
/// Makes the best simulated point the optimum, until a local search has a better one; the sigmas change
/// with the noise floor, and a fit that is stopped reports this point.
void take_best_point(FitContext& context);
/// Simulates points on the first search seed and adds them to context.points.
void add_points(FitContext& context, const Eigen::MatrixXd& unit_points);
/// Completed points, best chi-square first (ties in order of simulation).
std::vector<std::size_t> ranked_points(const FitContext& context);
/// Range of all search points and the optimum against the targets: fills `result`.
void set_reachability(const FitContext& context, std::size_t target, TargetResult& result);

// fit_stage_noise.cpp
/// Moderated variances of hold-outs: the prior is the variance of fitted targets of the same
/// statistic where there are any, else the sample's own.
Eigen::VectorXd holdout_variance(const FitContext& context, const Eigen::MatrixXd& samples,
                                 const Eigen::VectorXd& fitted_variance);
/// Moderated variances: (d0 v_prior + df v) / (d0 + df), d0 = 8, df = runs - 1.
/// @shape samples (num_targets, num_runs), prior (num_targets)
Eigen::VectorXd moderated_variance(const Eigen::MatrixXd& samples, const Eigen::VectorXd& prior);
/// The optimum on `num` seeds of a stage, see samples_over_seeds(). @pre optimum exists
Eigen::MatrixXd repeat_optimum(const FitContext& context, Evaluator& evaluator, SeedUse use, int num);
void run_noise(FitContext& context);

// fit_stage_gates.cpp
/// Are there as many independent observations, priors included, as free parameters?
Gate determination_gate(const FitContext& context);
/// All gates, on the runs of design and noise floor: into the summary and to options.report_gate.
void judge_gates(FitContext& context);

// fit_stage_search.cpp
void run_search_rounds(FitContext& context);

// fit_stage_local.cpp
/// How often the derivative of a free parameter could not be had.
using FrozenCounts = std::map<std::size_t, int>;
/// chi-square as Ceres sees it: means over the search seeds, derivatives by the rule of the options.
/// Context and counts must outlive it.
LeastSquaresProblem local_problem(FitContext& context, FrozenCounts& frozen);
void run_local_starts(FitContext& context);
/// One local search, booked as a start; context.optimum becomes its end if that is better.
void refit_from(FitContext& context, const Eigen::VectorXd& unit_start);

// fit_stage_bias.cpp
void run_bias(FitContext& context);

// fit_stage_uncertainty.cpp
/// Secants and covariance at the optimum; leaves them empty if its runs cannot be had.
void update_uncertainty(FitContext& context);
/// Standard errors in unit coordinates that the packings, and the sigma of targets and priors, would
/// give alone; their squares add up to the variance. @pre uncertainty and optimum exist
Eigen::VectorXd errors_from_packings(const FitContext& context);
Eigen::VectorXd errors_from_targets(const FitContext& context);

// fit_stage_profile.cpp
/// Profiles of all free parameters, and the family of equivalent sets.
void run_profiles(FitContext& context);
/// Verdict and interval of free parameter j by its profile; nothing if there is none.
void set_profile_verdict(const FitContext& context, std::size_t j, FittedParameter& fitted);

// fit_stage_parameters.cpp
/// Fills parameters, covariance, correlation and null directions of the summary.
void report_parameters(FitContext& context);

// fit_stage_fresh.cpp
/// Fresh-seed runs; fills targets and hold-outs of the summary.
void run_fresh(FitContext& context);

}  // namespace tilth
