// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/diagnosis_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/diagnosis/gap_size.hpp"
#include "calibrate/moderated_variances.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

constexpr double least_packing_variance = 1e-6;  ///< of T: what does not scatter at all is still not exact

std::string statistic_name(const SoilTarget& t) { return t.test_id + "." + t.observable_id + "@" + t.condition_id; }

/// Specimens and packings of the wanted statistics, renumbered 0, 1, ... in the order of `rows`.
std::vector<TestSamples> samples_of(const MeasuredCampaign& campaign, const Eigen::MatrixXd& packings,
                                    const std::vector<Eigen::Index>& rows) {
  std::vector<TestSamples> samples;
  for (const MeasuredTest& test : campaign.tests) {
    TestSamples s;
    std::vector<Eigen::Index> own, all;
    for (std::size_t k = 0; k < test.statistics.size(); ++k) {
      const auto at = std::ranges::find(rows, test.statistics[k]);
      if (at == rows.end()) continue;
      s.statistics.push_back(at - rows.begin());
      own.push_back(static_cast<Eigen::Index>(k));
      all.push_back(test.statistics[k]);
    }
    if (own.empty()) continue;
    s.replicates = test.replicates(Eigen::all, own);
    s.packings = packings(Eigen::all, all);
    samples.push_back(std::move(s));
  }
  return samples;
}

NoisePriors priors_of(const MeasuredCampaign& campaign, const Eigen::MatrixXd& packings,
                      const std::vector<Eigen::Index>& rows) {
  NoisePriors priors;
  priors.replicate_variances = campaign.prior_variances(rows);
  priors.packing_variances = pooled_packing_variances(campaign.means, packings)(rows);
  return priors;
}

std::vector<Eigen::Index> all_rows(const SoilCase& soil) {
  std::vector<Eigen::Index> rows(soil.targets.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<Eigen::Index>(k);
  return rows;
}

/// A parameter at its bound cannot absorb anything: it would have to go on.
void hold_at_bounds(const SoilCase& soil, SimulatedEvidence& e, std::vector<std::string>& remarks) {
  const std::vector<std::size_t> free = free_parameters(soil.parameters);
  for (Eigen::Index j = 0; j < soil.unit.size(); ++j) {
    if (soil.unit[j] > 0.0 && soil.unit[j] < 1.0) continue;
    const Parameter& p = soil.parameters[free[static_cast<std::size_t>(j)]];
    e.jacobian.col(j).setZero();
    e.jacobian_variances.col(j).setZero();
    remarks.push_back(fmt::format("{} of the best baseline is at its bound {:g}: it is held there and absorbs nothing", p.name,
                                  soil.unit[j] > 0.0 ? p.upper : p.lower));
  }
}

std::vector<NumericalGate> gates_of(const SoilCase& soil) {
  std::vector<NumericalGate> gates;
  for (std::size_t k = 0; k < soil.choices.size(); ++k) {
    const CandidateChoice& c = soil.choices[k];
    if (c.kind != EffectKind::numerical || !c.step.is_active) continue;
    NumericalGate gate{c.candidate.id, soil.simulated.not_simulated[k].empty(), 0.0, ""};
    for (const Eigen::Index i : soil.fitted) {
      const double shift = std::abs(soil.simulated.fingerprints(i, static_cast<Eigen::Index>(k)) * c.step.step()) /
                           std::sqrt(soil.covariance(i, i));
      if (gate.is_known && shift > gate.largest_shift) {
        gate.largest_shift = shift;
        gate.statistic = statistic_name(soil.campaign.means.targets[static_cast<std::size_t>(i)]);
      }
    }
    gates.push_back(gate);
  }
  return gates;
}

}  // namespace

SoilCase soil_case(const SoilData& soil) {
  SoilCase c;
  c.campaign = measured_campaign(soil);
  add_effect_parameters(c.campaign.means);
  c.remarks = c.campaign.remarks;
  if (!c.campaign.has_replicates)
    c.remarks.push_back("nothing was repeated with scatter: the noise is the stated sigma, which no data support; a name can be suggested at most");
  c.parameters = fit_parameters(c.campaign.means);
  c.targets = fit_targets(c.campaign.means);
  c.choices = candidate_choices(c.campaign.means);
  for (std::size_t k = 0; k < c.targets.size(); ++k)
    if (!c.targets[k].holdout) c.fitted.push_back(static_cast<Eigen::Index>(k));
  return c;
}

Eigen::VectorXd measured_means(const SoilCase& soil) {
  Eigen::VectorXd mean(static_cast<Eigen::Index>(soil.targets.size()));
  for (std::size_t k = 0; k < soil.targets.size(); ++k)
    mean[static_cast<Eigen::Index>(k)] = transformed(soil.targets[k], soil.targets[k].value);
  return mean;
}

Eigen::MatrixXd noise_covariance_of(const SoilCase& soil, const Eigen::MatrixXd& packings) {
  const auto rows = all_rows(soil);
  return noise_covariance(samples_of(soil.campaign, packings, rows), priors_of(soil.campaign, packings, rows)).total();
}

Eigen::MatrixXd finite_or_zero(const Eigen::MatrixXd& m) { return m.array().isFinite().select(m, 0.0); }

Eigen::VectorXd pooled_packing_variances(const SoilData& soil, const Eigen::MatrixXd& packings) {
  const Eigen::VectorXd own = sample_variances(packings.transpose());
  std::map<std::string, std::pair<double, double>> pools;
  for (std::size_t k = 0; k < soil.targets.size(); ++k) {
    auto& [sum, num] = pools[soil.targets[k].test_id + "/" + soil.targets[k].observable_id];
    sum += own[static_cast<Eigen::Index>(k)];
    num += 1.0;
  }
  Eigen::VectorXd pooled(own.size());
  for (std::size_t k = 0; k < soil.targets.size(); ++k) {
    const auto& [sum, num] = pools[soil.targets[k].test_id + "/" + soil.targets[k].observable_id];
    pooled[static_cast<Eigen::Index>(k)] = std::max(least_packing_variance, sum / num);
  }
  return pooled;
}

LinearModel linear_model(const SoilData& soil, const SimulatedEvidence& e, const std::vector<Eigen::Index>& rows) {
  LinearModel model;
  for (const Eigen::Index k : rows) {
    const SoilTarget& t = soil.targets[static_cast<std::size_t>(k)];
    model.statistics.push_back({t.test_id, statistic_name(t)});
  }
  model.jacobian = finite_or_zero(e.jacobian)(rows, Eigen::all);
  model.jacobian_variances = finite_or_zero(e.jacobian_variances)(rows, Eigen::all);
  Eigen::MatrixXd fingerprints = e.fingerprints, variances = e.fingerprint_variances;
  for (Eigen::Index k = 0; k < fingerprints.cols(); ++k)
    if (!e.not_simulated[static_cast<std::size_t>(k)].empty()) {
      fingerprints.col(k).setZero();
      variances.col(k).setZero();
    }
  model.fingerprints = fingerprints(rows, Eigen::all);
  model.fingerprint_variances = variances(rows, Eigen::all);
  return model;
}

std::vector<ExperimentGap> gaps_of(const SoilCase& soil, const Eigen::VectorXd& residual) {
  std::vector<ExperimentGap> gaps;
  const auto add = [&](const std::string& experiment, bool holdout) {
    std::vector<double> r, v;
    for (std::size_t k = 0; k < soil.targets.size(); ++k) {
      const SoilTarget& t = soil.campaign.means.targets[k];
      if (t.holdout != holdout || (!experiment.empty() && t.test_id != experiment)) continue;
      const auto i = static_cast<Eigen::Index>(k);
      const double scale = soil.campaign.scale[i];
      r.push_back(residual[i] / scale);
      v.push_back(soil.covariance(i, i) / (scale * scale));
    }
    if (r.empty()) return;
    const auto n = static_cast<Eigen::Index>(r.size());
    gaps.push_back({experiment, holdout, static_cast<int>(r.size()),
                    gap_size(Eigen::Map<const Eigen::VectorXd>(r.data(), n), Eigen::Map<const Eigen::VectorXd>(v.data(), n))});
  };
  std::vector<std::string> experiments;
  for (const SoilTarget& t : soil.campaign.means.targets)
    if (std::ranges::find(experiments, t.test_id) == experiments.end()) experiments.push_back(t.test_id);
  experiments.emplace_back();
  for (const bool holdout : {false, true})
    for (const std::string& e : experiments) add(e, holdout);
  return gaps;
}

std::vector<EffectStep> steps_of(const SoilCase& soil) {
  std::vector<EffectStep> steps;
  for (const CandidateChoice& c : soil.choices) steps.push_back(c.step);
  return steps;
}

void set_evidence(SoilCase& soil, SimulatedEvidence simulated) {
  soil.simulated = std::move(simulated);
  hold_at_bounds(soil, soil.simulated, soil.remarks);
  soil.covariance = noise_covariance_of(soil, soil.simulated.packings);
  soil.evidence.soil = soil.campaign.means.id;
  soil.evidence.model = linear_model(soil.campaign.means, soil.simulated, soil.fitted);
  soil.evidence.samples = samples_of(soil.campaign, soil.simulated.packings, soil.fitted);
  soil.evidence.noise = priors_of(soil.campaign, soil.simulated.packings, soil.fitted);
  if (const Eigen::VectorXd& more = soil.simulated.additional_variances; more.size() > 0) {
    soil.covariance.diagonal() += more;
    soil.evidence.noise.additional_variances = more(soil.fitted);
  }
  for (const CandidateChoice& c : soil.choices) soil.evidence.candidates.push_back(c.candidate);
  soil.gates = gates_of(soil);
}

}  // namespace tilth
