// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/diagnose/seek.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/optimise_ceres.hpp"
#include "calibrate/sobol_design.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth::scoreboard {
namespace {

constexpr int num_starts = 8;
constexpr double difference = 1e-4;               ///< of the unit cube; emulators are smooth
constexpr std::uint64_t proof_packing = 40'001;   ///< the block of refits
constexpr int num_proof_packings = 4;

/// Unit coordinates, then sizes over their ranges; everything in the box.
struct Unknowns {
  const EmulatedLaboratory& laboratory;
  const SoilCase& soil;
  const std::vector<std::size_t>& effects;
  std::vector<Eigen::Index> order;  ///< of the case's targets

  const EffectParameter& parameter(std::size_t k) const { return *soil.choices[effects[k]].parameter; }
  Eigen::Index num_free() const { return laboratory.library().lower.size(); }
  Eigen::VectorXd sizes(const Eigen::VectorXd& x) const {  ///< distances from the null
    Eigen::VectorXd s(static_cast<Eigen::Index>(effects.size()));
    for (std::size_t k = 0; k < effects.size(); ++k) {
      const EffectParameter& p = parameter(k);
      const auto i = static_cast<Eigen::Index>(k);
      s[i] = p.lower + (p.upper - p.lower) * x[num_free() + i] - p.null_value;
    }
    return s;
  }
  Eigen::VectorXd lower() const {
    Eigen::VectorXd l = Eigen::VectorXd::Zero(num_free() + static_cast<Eigen::Index>(effects.size()));
    l.head(num_free()) = laboratory.library().lower;
    return l;
  }
  Eigen::VectorXd upper() const {
    Eigen::VectorXd u = Eigen::VectorXd::Ones(num_free() + static_cast<Eigen::Index>(effects.size()));
    u.head(num_free()) = laboratory.library().upper;
    return u;
  }
  Eigen::VectorXd start(const Eigen::VectorXd& unit) const {
    Eigen::VectorXd x(num_free() + static_cast<Eigen::Index>(effects.size()));
    x.head(num_free()) = unit;
    for (std::size_t k = 0; k < effects.size(); ++k)
      x[num_free() + static_cast<Eigen::Index>(k)] =
          (parameter(k).null_value - parameter(k).lower) / (parameter(k).upper - parameter(k).lower);
    return x;
  }
  Eigen::VectorXd predicted(const Eigen::VectorXd& x) const {
    return laboratory.mean_with(x.head(num_free()), effects, sizes(x))(order);
  }
  Eigen::MatrixXd derivatives(const Eigen::VectorXd& x) const {
    Eigen::MatrixXd d(static_cast<Eigen::Index>(order.size()), x.size());
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      Eigen::VectorXd high = x, low = x;
      high[j] += difference;
      low[j] -= difference;
      d.col(j) = (predicted(high) - predicted(low)) / (2.0 * difference);
    }
    return d;
  }
};

/// Physical values of a model: parameters, effects and what these need beside their sizes.
Eigen::VectorXd physical(const SoilCase& soil, const EmulatedFit& model) {
  Eigen::VectorXd values = physical_point(soil.parameters, model.unit);
  for (std::size_t k = 0; k < model.effects.size(); ++k) {
    const CandidateChoice& c = soil.choices[model.effects[k]];
    for (const auto& [column, value] : c.step.settings) values[column] = value;
    values[c.step.settings.front().first] = c.step.null_value + model.sizes[static_cast<Eigen::Index>(k)];
  }
  return values;
}

Eigen::VectorXd whitened_fitted(const SoilCase& soil, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residual) {
  const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(covariance(soil.fitted, soil.fitted)));
  return root.matrixL().solve(Eigen::VectorXd(residual(soil.fitted)));
}

double total_gap(const SoilCase& soil, const Eigen::VectorXd& residual, bool holdout) {
  for (const ExperimentGap& g : gaps_of(soil, residual))
    if (g.experiment.empty() && g.holdout == holdout) return g.gap;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

EmulatedFit emulated_fit(const EmulatedLaboratory& laboratory, const SoilCase& soil, const Eigen::MatrixXd& covariance,
                         const std::vector<std::size_t>& effects) {
  const Unknowns unknowns{laboratory, soil, effects, laboratory.order_of(soil)};
  const Eigen::VectorXd measured = measured_means(soil);
  const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(covariance(soil.fitted, soil.fitted)));
  LeastSquaresProblem problem;
  problem.lower = unknowns.lower();
  problem.upper = unknowns.upper();
  problem.num_residuals = static_cast<int>(soil.fitted.size());
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    residuals = root.matrixL().solve(Eigen::VectorXd((measured - unknowns.predicted(x))(soil.fitted)));
    if (jacobian != nullptr)
      *jacobian = -root.matrixL().solve(Eigen::MatrixXd(unknowns.derivatives(x)(soil.fitted, Eigen::all)));
    return true;
  };
  const Library& library = laboratory.library();
  Eigen::MatrixXd starts = shifted_sobol_points(num_starts, static_cast<int>(library.lower.size()), 1);
  starts = (starts.array().colwise() * (library.upper - library.lower).array()).matrix().colwise() + library.lower;
  starts.col(0) = unit_start(soil.parameters);
  EmulatedFit best;
  best.effects = effects;
  best.chi_square = std::numeric_limits<double>::infinity();
  for (Eigen::Index s = 0; s < starts.cols(); ++s) {
    const LeastSquaresResult found = minimise_with_ceres(problem, unknowns.start(starts.col(s)), {});
    if (!found.usable || !(found.sum_of_squares < best.chi_square)) continue;
    best.chi_square = found.sum_of_squares;
    best.unit = found.x.head(library.lower.size());
    best.sizes = unknowns.sizes(found.x);
  }
  return best;
}

Finding seek(const EmulatedLaboratory& laboratory, const std::filesystem::path& data, const std::string& struck,
             const DiagnosisOptions& options) {
  Finding f{soil_case(load_soil(data)), {}, {}};
  SoilCase& soil = f.soil;
  for (CandidateChoice& c : soil.choices)
    if (c.candidate.id == struck) c.step.is_active = false;
  const SimulatedEvidence nominal = laboratory.evidence(soil, unit_start(soil.parameters));
  Eigen::MatrixXd covariance = noise_covariance_of(soil, nominal.packings);
  covariance.diagonal() += nominal.additional_variances;
  f.baseline = emulated_fit(laboratory, soil, covariance, {});
  // The edge of the library is no bound of the soil: a hair inside, where a parameter still absorbs.
  soil.unit = f.baseline.unit;
  set_evidence(soil, laboratory.evidence(soil, soil.unit));
  std::vector<SoilCase> soils = {soil};
  f.diagnosis = decided(soils, options);
  return f;
}

std::vector<ProvenGap> prove(const EmulatedLaboratory& laboratory, const std::vector<ProofJob>& jobs, Fidelity fidelity,
                             const RunContext& context) {
  if (jobs.empty()) return {};
  const Library& library = laboratory.library();
  const std::vector<Target> targets = fit_targets(library.soil);
  const Simulator simulator = dem_simulator(library.soil, fidelity, context, TargetScope::all, FailedTest::leaves_others);
  // (p) measured - mean over packings, targets in the order of the case; empty where none was whole
  const auto residuals_at = [&](const std::vector<EmulatedFit>& models) {
    Eigen::MatrixXd values(static_cast<Eigen::Index>(library.parameters.size()),
                           static_cast<Eigen::Index>(models.size()) * num_proof_packings);
    std::vector<std::uint64_t> packings;
    for (int n = 0; n < num_proof_packings; ++n)
      for (std::size_t k = 0; k < models.size(); ++k) {
        values.col(static_cast<Eigen::Index>(packings.size())) = physical(jobs[k].finding->soil, models[k]);
        packings.push_back(proof_packing + static_cast<std::uint64_t>(n));
      }
    const std::vector<Evaluation> runs = simulator(values, packings);
    std::vector<Eigen::VectorXd> residuals;
    for (std::size_t k = 0; k < models.size(); ++k) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(targets.size()));
      int num = 0;
      for (int n = 0; n < num_proof_packings; ++n) {
        const Eigen::VectorXd t = transformed_features(targets, runs[static_cast<std::size_t>(n) * models.size() + k]);
        if (!t.allFinite()) continue;
        sum += t;
        ++num;
      }
      const SoilCase& soil = jobs[k].finding->soil;
      residuals.push_back(num == 0 ? Eigen::VectorXd()
                                   : Eigen::VectorXd(measured_means(soil) - Eigen::VectorXd((sum / num)(laboratory.order_of(soil)))));
    }
    return residuals;
  };

  std::vector<EmulatedFit> first, second;
  for (const ProofJob& j : jobs) first.push_back(j.model);
  const std::vector<Eigen::VectorXd> at_first = residuals_at(first);
  second = first;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (at_first[k].size() == 0) continue;
    const SoilCase& soil = jobs[k].finding->soil;
    const Unknowns unknowns{laboratory, soil, first[k].effects, laboratory.order_of(soil)};
    Eigen::VectorXd x = unknowns.start(first[k].unit);
    for (std::size_t e = 0; e < first[k].effects.size(); ++e) {
      const EffectParameter& p = unknowns.parameter(e);
      const auto i = static_cast<Eigen::Index>(e);
      x[unknowns.num_free() + i] = (p.null_value + first[k].sizes[i] - p.lower) / (p.upper - p.lower);
    }
    const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(soil.covariance(soil.fitted, soil.fitted)));
    const Eigen::MatrixXd a = root.matrixL().solve(Eigen::MatrixXd(unknowns.derivatives(x)(soil.fitted, Eigen::all)));
    const Eigen::VectorXd step =
        a.completeOrthogonalDecomposition().solve(whitened_fitted(soil, soil.covariance, at_first[k]));
    x = (x + step).cwiseMax(unknowns.lower()).cwiseMin(unknowns.upper());
    second[k].unit = x.head(unknowns.num_free());
    second[k].sizes = unknowns.sizes(x);
  }
  const std::vector<Eigen::VectorXd> at_second = residuals_at(second);
  std::vector<ProvenGap> proven;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    const SoilCase& soil = jobs[k].finding->soil;
    const auto chi_square = [&](const Eigen::VectorXd& r) {
      return r.size() == 0 ? std::numeric_limits<double>::infinity() : whitened_fitted(soil, soil.covariance, r).squaredNorm();
    };
    const bool is_second = chi_square(at_second[k]) < chi_square(at_first[k]);
    const Eigen::VectorXd& residual = is_second ? at_second[k] : at_first[k];
    ProvenGap g{std::nan(""), std::nan(""), (is_second ? second : first)[k].sizes};
    if (residual.size() > 0) {
      g.fitted = total_gap(soil, residual, false);
      g.held_out = total_gap(soil, residual, true);
    }
    proven.push_back(g);
  }
  return proven;
}

}  // namespace tilth::scoreboard
