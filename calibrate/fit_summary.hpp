// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// What a fit found, how sure it is, and how it ended.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/evaluator.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// Why fit() returned.
enum class Termination {
  not_called,
  converged,          ///< the best local search met its stopping rule
  no_convergence,     ///< it ran out of iterations, or no local search could be started
  budget_spent,       ///< max_simulations
  stopped,            ///< should_stop()
  too_many_failures,  ///< more than 30 % of a batch of at least 8 failed
  under_determined,   ///< more free parameters than observations, and no force
  bad_input,          ///< problems() of parameters, targets or options
};
std::string_view to_string(Termination termination);

/// Is a target inside what the model produced in all search runs?
enum class Reachability {
  unknown,
  reachable,    ///< inside the range
  edge,         ///< outside by at most 2 sigma_total
  unreachable,  ///< outside by more
};
std::string_view to_string(Reachability reachability);

/// What is known about a parameter: by its profile likelihood (profile.hpp) where there is one, else
/// by the linear interval.
enum class ParameterVerdict {
  unknown,        ///< neither profile nor covariance
  fixed,          ///< was not estimated
  identified,     ///< the 95 % level is crossed on both sides, inside the bounds
  one_sided,      ///< on one side only: practical, better data may close the other
  flat,           ///< on neither side: the data do not fix it within its bounds
  bound_limited,  ///< crossed only because another parameter ran into its bound
  multimodal,     ///< crossed, and come back below: separate regions fit equally well
};
std::string_view to_string(ParameterVerdict verdict);

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// One parameter after the fit; physical unless said otherwise.
struct FittedParameter {
  std::string name;
  double start = not_known;
  double value = not_known;
  double lo95 = not_known;            ///< clipped at lower
  double hi95 = not_known;            ///< clipped at upper
  double standard_error = not_known;  ///< in the coordinate (relative if log_scale)
  double standard_error_targets = not_known;   ///< its part due to the sigma of targets and priors
  double standard_error_packings = not_known;  ///< its part due to packings; squares add up
  double inflation = not_known;  ///< standard error / that with all other parameters held
  double profile_lo95 = not_known;  ///< where the profile crosses the level; NaN where it does not
  double profile_hi95 = not_known;
  double lower = not_known;
  double upper = not_known;
  bool log_scale = false;
  bool estimate = true;
  ParameterVerdict verdict = ParameterVerdict::unknown;
  std::string limited_by;    ///< of a bound_limited one: the parameter that ran into its bound
  std::string expression;    ///< "1.5*other" where the value follows another parameter
  std::string no_error_bar;  ///< completes "no error bar because ..."; empty if there is one
};

/// The verdict with its reason: "bound_limited(by=friction)".
std::string verdict_words(const FittedParameter& parameter);

/// One target after the fit. "T" marks quantities of the transformed value (ln if log_transform).
struct TargetResult {
  std::string name;
  Provenance provenance = Provenance::synthetic;
  bool log_transform = false;
  double value = not_known;         ///< physical
  double sigma = not_known;         ///< T, as given
  double simulated = not_known;     ///< physical, mean over the fresh seeds (else search seeds)
  double seed_sd = not_known;       ///< T, scatter of one simulation, moderated
  double sigma_total = not_known;   ///< T, what the residual is divided by
  double residual = not_known;      ///< (T(simulated) - T(value)) / sigma_total
  double parameter_sd = not_known;  ///< T, from the covariance; in sigma_total of hold-outs only
  Reachability reachability = Reachability::unknown;  ///< fitted targets only
  double reach_gap = not_known;   ///< distance outside the range / sigma_total; < 0 inside
  std::string conflicts_with;       ///< a target that cannot be met together with this one; or empty
  double joint_misfit = not_known;  ///< of the two, see TargetConflict
  double bias = 0.0;              ///< T, mean confirm - mean search at the optimum
  double bias_error = not_known;  ///< T, its standard error; NaN without a confirming simulator
};

/// What a model says of one target; T.
struct TargetPrediction {
  double mean = not_known;
  double variance = not_known;         ///< of the mean, by packings
  double variance_of_one = not_known;  ///< of one simulation
  double parameter_sd = not_known;     ///< NaN: cannot be told, left out
};

/// A target beside its prediction: everything of TargetResult but reachability, conflicts and bias.
///   sigma_total^2 = sigma^2 + variance,  + parameter_sd^2 for hold-outs, which took no part in the fit
TargetResult compared(const Target& target, const TargetPrediction& prediction);

/// Two fitted targets that can each be met, but not both with one parameter set.
struct TargetConflict {
  std::string first;
  std::string second;
  double misfit = not_known;    ///< the smaller they can both be made, in sigma_total; > conflict_limit
  bool same_statistic = false;  ///< one observable under two conditions: the model's trend is wrong
};
inline constexpr double conflict_limit = 2.0;

/// The profile of one free parameter: chi-square with this parameter held and the others fitted.
struct ParameterProfile {
  std::string parameter;
  std::vector<double> values;                 ///< physical, ascending
  std::vector<double> chi_square_difference;  ///< above the least of all profiles, >= 0
  std::vector<Eigen::VectorXd> points;        ///< all parameters, physical, table order
  std::vector<std::string> at_bound;          ///< another parameter held by its bound there; or ""
};

/// A parameter set that fits as well as the best one within the noise.
struct EquivalentSet {
  Eigen::VectorXd values;  ///< all parameters, physical, table order
  double chi_square_difference = 0.0;
};

/// One curve of the data: how many points, and how many independent ones they are worth.
struct CurveSampleSize {
  std::string curve;
  std::size_t num_points = 0;
  double effective = not_known;  ///< see effective_sample_size()
};

/// A question that is answered before the search spends its simulations.
struct Gate {
  std::string name;  ///< "noise floor", "reachability", "under-determination"
  bool passed = false;
  std::string words;  ///< why, with the numbers
};

/// One local search.
struct StartResult {
  std::string stage;      ///< "local search", or "bias" for a refit
  Eigen::VectorXd start;  ///< physical, all parameters
  Eigen::VectorXd value;
  double chi_square_start = not_known;
  double chi_square = not_known;
  int num_iterations = 0;
  bool usable = false;     ///< value is at least as good as start
  bool converged = false;  ///< its stopping rule was met
  std::string message;
};

/// chi-square after so many simulations, on the seeds of that stage.
struct CostPoint {
  std::string stage;
  std::size_t num_simulations = 0;
  double chi_square = not_known;
};

struct FitSummary {
  Termination termination = Termination::not_called;
  std::string message = "fit() was not called";

  std::vector<FittedParameter> parameters;  ///< all, in table order
  std::vector<TargetResult> targets;        ///< the fitted ones, in table order
  std::vector<TargetResult> holdouts;

  std::vector<Gate> gates;                ///< as judged before the search
  std::vector<TargetConflict> conflicts;  ///< largest misfit first

  double chi_square_start = not_known;  ///< start values, first search seed
  double chi_square = not_known;  ///< optimum, search seeds, priors included: what was minimised
  double chi_square_fresh = not_known;  ///< optimum, fresh seeds, fitted targets only
  /// 1 - chi-square / weighted squares about the weighted mean target; NaN unless all fitted targets
  /// are one statistic, since numbers of different units have no mean
  double r_squared = not_known;
  std::size_t num_free = 0;
  std::size_t num_observations = 0;  ///< fitted targets + priors of free parameters
  std::size_t num_independent = 0;   ///< observation groups + priors of free parameters
  int degrees_of_freedom = 0;        ///< num_observations - num_free
  int num_noise_seeds = 0;           ///< completed repeats behind seed_sd
  int num_fresh_seeds = 0;           ///< completed runs behind chi_square_fresh
  double holdout_rms = not_known;    ///< root mean square hold-out residual; NaN without hold-outs
  double holdout_limit = not_known;  ///< the pass mark it is compared with

  std::vector<StartResult> starts;
  int num_starts = 0;          ///< of the local search, refits not counted
  int num_starts_at_best = 0;  ///< those whose chi-square is within 0.1 of the best
  std::vector<CostPoint> history;

  /// Of the free parameters, in the coordinate (ln v if log_scale), without null directions.
  /// sigma is absolute, or multiplied by sigma_scale where that is asked for. Empty if unknown.
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd correlation;               ///< NaN where a parameter has no error bar
  std::vector<std::string> null_directions;  ///< in words
  std::vector<std::string> near_null_directions;  ///< in words: barely fixed
  bool sigma_is_rescaled = false;
  double sigma_scale = 1.0;      ///< sqrt(reduced chi-square) if rescaled
  double interval_factor = 1.959963984540054;  ///< half-widths of 95 % intervals / standard error

  std::vector<ParameterProfile> profiles;  ///< of the free parameters, table order; may be empty
  std::string profile_source;              ///< on what they were drawn, in words
  double profile_level = not_known;        ///< chi-square difference of the 95 % interval
  std::vector<EquivalentSet> equivalence_family;  ///< the optimum first; empty without profiles
  std::vector<CurveSampleSize> sample_sizes;      ///< filled by who reruns the tests; fit() sees no curves
  Eigen::MatrixXd seed_covariance;           ///< T of the fitted targets, one simulation

  int num_bias_rounds = 0;
  double last_bias_shift = not_known;  ///< largest move of a parameter / its standard error

  std::size_t num_simulations = 0;  ///< completed + failed
  std::vector<StageCount> stages;
  std::vector<FailedRun> failures;
  std::vector<std::string> warnings;

  /// A local search ended at a point at least as good as its start, on complete runs.
  bool is_usable() const;
  /// Did the hold-out criterion fail? (false without hold-outs)
  bool holdout_failed() const;
  /// Largest conflict of a target with the same statistic under another condition; null if none.
  const TargetConflict* trend_conflict(const std::string& target) const;
  /// Is any fitted target unreachable, alone or together with one of its own statistic?
  bool has_unreachable_target() const;
  /// Values of all parameters, physical, in table order.
  Eigen::VectorXd values() const;
  /// One line: how it ended, chi-square before and after, simulations.
  std::string brief_report() const;
};

}  // namespace tilth
