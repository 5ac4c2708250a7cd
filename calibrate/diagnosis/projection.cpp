// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/projection.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calibrate/diagnosis/thresholds.hpp"

namespace tilth {
namespace {

void check(const LinearModel& model, const Eigen::VectorXd& residual,
           const Eigen::MatrixXd& covariance) {
  const Eigen::Index p = residual.size();
  const Eigen::Index q = model.jacobian.cols();
  const auto num_statistics = static_cast<Eigen::Index>(model.statistics.size());
  const bool has_priors = model.prior_precision.size() > 0;
  const auto is_absent_or_like = [](const Eigen::MatrixXd& noise, const Eigen::MatrixXd& values) {
    return noise.size() == 0 || (noise.rows() == values.rows() && noise.cols() == values.cols());
  };
  if (num_statistics != p || model.jacobian.rows() != p || model.fingerprints.rows() != p ||
      covariance.rows() != p || covariance.cols() != p ||
      (has_priors && (model.prior_precision.size() != q || model.prior_offset.size() != q)) ||
      !is_absent_or_like(model.fingerprint_variances, model.fingerprints) ||
      !is_absent_or_like(model.jacobian_variances, model.jacobian))
    throw std::invalid_argument(
        "diagnosis: statistics, residual, covariance, jacobian, priors and "
        "fingerprints differ in size");
  if (!residual.allFinite() || !covariance.allFinite() || !model.jacobian.allFinite() ||
      !model.fingerprints.allFinite())
    throw std::invalid_argument(
        "diagnosis: a residual, a covariance, a derivative or a fingerprint "
        "is not a finite number");
}

Eigen::MatrixXd basis_of_complement(const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.rows();
  if (jacobian.cols() == 0) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  return q.rightCols(n - qr.rank());
}

// tr(B' L^-1 diag(v_k) L^-T B) for every effect; v_k the variances of the fingerprint and, through
// the parameters beta that imitate it, of the jacobian.
Eigen::VectorXd noise_norms(const LinearModel& model, const WhitenedEvidence& w,
                            const Eigen::MatrixXd& basis) {
  const Eigen::Index p = w.root.rows();
  Eigen::MatrixXd variances = Eigen::MatrixXd::Zero(p, model.fingerprints.cols());
  if (model.fingerprint_variances.size() > 0) variances = model.fingerprint_variances;
  if (model.jacobian_variances.size() > 0) {
    const Eigen::MatrixXd beta =
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(w.jacobian).solve(w.fingerprints);
    variances += model.jacobian_variances * beta.cwiseAbs2();
  }
  const Eigen::MatrixXd unwhitened =
      w.root.transpose().triangularView<Eigen::Upper>().solve(Eigen::MatrixXd(basis.topRows(p)));
  return variances.transpose() * unwhitened.rowwise().squaredNorm();
}

}  // namespace

bool ProjectedEvidence::is_measurable(Eigen::Index effect) const {
  const double norm = fingerprints.col(effect).squaredNorm();
  // Below 1e-12 of |s|^2 the projection leaves rounding only.
  return kept[effect] > 1e-12 &&
         norm >= diagnosis_thresholds::measurable_ratio * noise_norms[effect];
}

WhitenedEvidence whitened(const LinearModel& model, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& covariance) {
  check(model, residual, covariance);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (cholesky.info() != Eigen::Success)
    throw std::invalid_argument(
        "diagnosis: the covariance of the residuals is not positive definite");
  const Eigen::Index p = residual.size();
  const Eigen::Index n = p + (model.prior_precision.array() > 0.0).count();
  WhitenedEvidence w{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, model.jacobian.cols()),
                     Eigen::MatrixXd::Zero(n, model.fingerprints.cols()), cholesky.matrixL()};
  w.residual.head(p) = cholesky.matrixL().solve(residual);
  w.jacobian.topRows(p) = cholesky.matrixL().solve(model.jacobian);
  w.fingerprints.topRows(p) = cholesky.matrixL().solve(model.fingerprints);
  Eigen::Index row = p;
  for (Eigen::Index j = 0; j < model.prior_precision.size(); ++j) {
    if (!(model.prior_precision[j] > 0.0)) continue;
    const double root = std::sqrt(model.prior_precision[j]);
    w.residual[row] = root * model.prior_offset[j];
    w.jacobian(row++, j) = root;
  }
  return w;
}

ProjectedEvidence project(const LinearModel& model, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& covariance) {
  const WhitenedEvidence w = whitened(model, residual, covariance);
  ProjectedEvidence e;
  e.basis = basis_of_complement(w.jacobian);
  e.u = e.basis.transpose() * w.residual;
  e.fingerprints = e.basis.transpose() * w.fingerprints;
  const Eigen::ArrayXd all = w.fingerprints.colwise().squaredNorm().transpose().array();
  const Eigen::ArrayXd left = e.fingerprints.colwise().squaredNorm().transpose().array();
  e.kept = (all > 0.0).select(left / all, 0.0);
  e.noise_norms = noise_norms(model, w, e.basis);
  e.experiments.assign(static_cast<std::size_t>(w.residual.size()), "");
  std::ranges::transform(model.statistics, e.experiments.begin(), &Statistic::experiment);
  return e;
}

EvidenceRows selected_rows(const LinearModel& model, const Eigen::VectorXd& residual,
                           const Eigen::MatrixXd& covariance,
                           const std::vector<Eigen::Index>& statistics) {
  EvidenceRows part{model, residual(statistics), covariance(statistics, statistics)};
  part.model.statistics.clear();
  for (const Eigen::Index i : statistics)
    part.model.statistics.push_back(model.statistics[static_cast<std::size_t>(i)]);
  part.model.jacobian = model.jacobian(statistics, Eigen::all);
  part.model.fingerprints = model.fingerprints(statistics, Eigen::all);
  if (model.fingerprint_variances.size() > 0)
    part.model.fingerprint_variances = model.fingerprint_variances(statistics, Eigen::all);
  if (model.jacobian_variances.size() > 0)
    part.model.jacobian_variances = model.jacobian_variances(statistics, Eigen::all);
  return part;
}

std::vector<Eigen::Index> rows_of(const LinearModel& model, const std::string& experiment,
                                  bool complement) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < model.statistics.size(); ++i)
    if ((model.statistics[i].experiment == experiment) != complement)
      rows.push_back(static_cast<Eigen::Index>(i));
  return rows;
}

std::vector<std::string> experiments_of(const LinearModel& model) {
  std::vector<std::string> names;
  for (const Statistic& statistic : model.statistics)
    if (std::ranges::find(names, statistic.experiment) == names.end())
      names.push_back(statistic.experiment);
  return names;
}

}  // namespace tilth
