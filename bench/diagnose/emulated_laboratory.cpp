// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/diagnose/emulated_laboratory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "calibrate/secants.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth::scoreboard {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t first_common_packing = 30'001;

Eigen::VectorXd transformed_row(const std::vector<Target>& targets, const Eigen::VectorXd& features) {
  return transformed_features(targets, {EvaluationStatus::completed, features, ""});
}

std::string name_of_target(const SoilTarget& t) { return t.test_id + "." + t.observable_id + "@" + t.condition_id; }

}  // namespace

EmulatedLaboratory::EmulatedLaboratory(const Library& library)
    : library_(library), nominal_(unit_start(library.parameters)) {
  const std::vector<Target> targets = fit_targets(library.soil);
  fit_means(targets);
  fit_fingerprints(targets);
}

void EmulatedLaboratory::fit_means(const std::vector<Target>& targets) {
  const auto p = static_cast<Eigen::Index>(targets.size());
  std::map<int, std::vector<Eigen::VectorXd>> design;  // by point
  std::vector<Eigen::VectorXd> nominal, common;
  for (const LibraryRow& r : library_.rows) {
    const Eigen::VectorXd t = transformed_row(targets, r.features);
    if (r.kind == RowKind::design) design[r.point].push_back(t);
    if (r.kind == RowKind::nominal && t.allFinite()) (r.packing >= first_common_packing ? common : nominal).push_back(t);
  }
  if (nominal.size() < 4 || common.empty()) throw std::runtime_error("library: too few packings completed at the nominal values");
  const auto mean_of = [p](const std::vector<Eigen::VectorXd>& rows) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(p);
    for (const Eigen::VectorXd& r : rows) sum += r;
    return Eigen::VectorXd(sum / static_cast<double>(rows.size()));
  };
  offset_ = mean_of(nominal) - mean_of(common);
  packings_.resize(static_cast<Eigen::Index>(nominal.size()), p);
  for (std::size_t k = 0; k < nominal.size(); ++k)
    packings_.row(static_cast<Eigen::Index>(k)) = nominal[k] - mean_of(nominal);

  for (Eigen::Index i = 0; i < p; ++i) {
    std::vector<Eigen::Index> used;
    std::vector<double> values;
    for (const auto& [point, rows] : design) {
      double sum = 0.0;
      for (const Eigen::VectorXd& r : rows) sum += r[i];
      if (!std::isfinite(sum) || rows.size() != common.size()) continue;  // only whole sets of packings compare
      used.push_back(point);
      values.push_back(sum / static_cast<double>(rows.size()));
    }
    EmulatorOptions options;
    options.trend = EmulatorTrend::quadratic;
    emulators_.emplace_back(library_.points(Eigen::all, used),
                            Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())), options);
  }
}

void EmulatedLaboratory::fit_fingerprints(const std::vector<Target>& targets) {
  const auto p = static_cast<Eigen::Index>(targets.size());
  std::map<std::pair<int, std::uint64_t>, Eigen::VectorXd> base;
  for (const LibraryRow& r : library_.rows)
    if (r.kind == RowKind::design) base[{r.point, r.packing}] = transformed_row(targets, r.features);
  fingerprints_.resize(library_.choices.size());
  for (std::size_t c = 0; c < library_.choices.size(); ++c) {
    fingerprints_[c].resize(targets.size());
    std::vector<Eigen::VectorXd> points, secants;
    for (const LibraryRow& r : library_.rows) {
      if (r.candidate != static_cast<int>(c)) continue;
      points.push_back(library_.points.col(r.point));
      secants.push_back((transformed_row(targets, r.features) - base.at({r.point, r.packing})) /
                        library_.choices[c].step.step());
    }
    for (Eigen::Index i = 0; i < p; ++i) {
      std::vector<std::size_t> used;
      for (std::size_t n = 0; n < secants.size(); ++n)
        if (std::isfinite(secants[n][i])) used.push_back(n);
      const auto num = static_cast<Eigen::Index>(used.size());
      if (num < min_emulator_points(EmulatorTrend::linear, nominal_.size())) continue;
      Eigen::MatrixXd x(nominal_.size(), num);
      Eigen::VectorXd y(num);
      for (Eigen::Index n = 0; n < num; ++n) {
        x.col(n) = points[used[static_cast<std::size_t>(n)]];
        y[n] = secants[used[static_cast<std::size_t>(n)]][i];
      }
      fingerprints_[c][static_cast<std::size_t>(i)].emplace(x, y, EmulatorOptions{});
    }
  }
}

Eigen::VectorXd EmulatedLaboratory::mean(const Eigen::VectorXd& unit) const {
  Eigen::VectorXd m = offset_;
  for (std::size_t i = 0; i < emulators_.size(); ++i) m[static_cast<Eigen::Index>(i)] += emulators_[i].predict_mean(unit);
  return m;
}

Eigen::VectorXd EmulatedLaboratory::mean_with(const Eigen::VectorXd& unit, const std::vector<std::size_t>& candidates,
                                              const Eigen::VectorXd& sizes) const {
  Eigen::VectorXd m = mean(unit);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    for (Eigen::Index i = 0; i < m.size(); ++i)
      if (const auto& f = fingerprints_[candidates[k]][static_cast<std::size_t>(i)])
        m[i] += sizes[static_cast<Eigen::Index>(k)] * f->predict_mean(unit);
  return m;
}

std::vector<Eigen::Index> EmulatedLaboratory::order_of(const SoilCase& soil) const {
  std::vector<Eigen::Index> order;
  for (const SoilTarget& t : soil.campaign.means.targets) {
    const auto& ours = library_.soil.targets;
    const auto at = std::ranges::find(ours, name_of_target(t), name_of_target);
    if (at == ours.end()) throw std::runtime_error("library: lacks " + name_of_target(t));
    order.push_back(at - ours.begin());
  }
  return order;
}

SimulatedEvidence EmulatedLaboratory::evidence(const SoilCase& soil, const Eigen::VectorXd& unit) const {
  const auto p = static_cast<Eigen::Index>(emulators_.size()), q = unit.size();
  const auto num_effects = static_cast<Eigen::Index>(library_.choices.size());
  SimulatedEvidence e;
  e.packings = packings_.rowwise() + mean(unit).transpose();
  e.additional_variances.resize(p);
  for (Eigen::Index i = 0; i < p; ++i) e.additional_variances[i] = emulators_[static_cast<std::size_t>(i)].predict(unit).variance;

  const EvidencePlan steps_of_plan;
  const Eigen::VectorXd steps = secant_steps(library_.parameters, steps_of_plan.log_step, steps_of_plan.linear_step);
  e.jacobian.resize(p, q);
  e.jacobian_variances.resize(p, q);
  for (Eigen::Index j = 0; j < q; ++j) {
    Eigen::VectorXd high = unit, low = unit;
    high[j] = std::min(library_.upper[j], unit[j] + steps[j]);
    low[j] = std::max(library_.lower[j], unit[j] - steps[j]);
    const double width = high[j] - low[j];
    for (Eigen::Index i = 0; i < p; ++i) {
      const EmulatorPrediction d = emulators_[static_cast<std::size_t>(i)].predict_difference(high, low);
      e.jacobian(i, j) = d.mean / width;
      e.jacobian_variances(i, j) = d.variance / (width * width);
    }
  }

  e.fingerprints = e.fingerprint_variances = Eigen::MatrixXd::Constant(p, num_effects, nan_value);
  e.not_simulated.assign(library_.choices.size(), "");
  for (Eigen::Index k = 0; k < num_effects; ++k)
    for (Eigen::Index i = 0; i < p; ++i) {
      const auto& f = fingerprints_[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
      if (!f) continue;
      const EmulatorPrediction s = f->predict(unit);
      e.fingerprints(i, k) = s.mean;
      e.fingerprint_variances(i, k) = s.variance;
    }
  // into the order of the case
  const std::vector<Eigen::Index> order = order_of(soil);
  e.packings = Eigen::MatrixXd(e.packings(Eigen::all, order));
  for (Eigen::MatrixXd* m : {&e.jacobian, &e.jacobian_variances, &e.fingerprints, &e.fingerprint_variances})
    *m = Eigen::MatrixXd((*m)(order, Eigen::all));
  e.additional_variances = Eigen::VectorXd(e.additional_variances(order));
  for (std::size_t k = 0; k < library_.choices.size(); ++k) {
    if (!soil.choices[k].step.is_active) e.not_simulated[k] = "none of these tests depends on it";
    else if (!e.fingerprints.col(static_cast<Eigen::Index>(k))(soil.fitted).allFinite())
      e.not_simulated[k] = "too few runs of the library could be compared";
  }
  return e;
}

std::vector<EmulatorQuality> EmulatedLaboratory::quality() const {
  std::vector<EmulatorQuality> all;
  for (std::size_t i = 0; i < emulators_.size(); ++i) {
    const LeaveOneOut left = emulators_[i].leave_one_out();
    all.push_back({name_of_target(library_.soil.targets[i]), left.q2,
                   std::sqrt(left.residuals.squaredNorm() / static_cast<double>(left.residuals.size()))});
  }
  return all;
}

}  // namespace tilth::scoreboard
