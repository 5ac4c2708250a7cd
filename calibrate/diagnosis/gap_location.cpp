// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/gap_location.hpp"

#include <cmath>
#include <limits>

#include "calibrate/diagnosis/normal_probability.hpp"

namespace tilth {
namespace {

// Chi-square and degrees of freedom of the baseline on some of the statistics.
struct Misfit {
  double chi_square = 0.0;
  double freedom = 0.0;
};

Misfit misfit_of(const LinearModel& model, const Eigen::VectorXd& residual,
                 const Eigen::MatrixXd& covariance, const std::vector<Eigen::Index>& rows) {
  if (rows.empty()) return {};
  const EvidenceRows part = selected_rows(model, residual, covariance, rows);
  const ProjectedEvidence left = project(part.model, part.residual, part.covariance);
  return {left.u.squaredNorm(), static_cast<double>(left.nu())};
}

}  // namespace

Eigen::VectorXd standardised_residuals(const LinearModel& model, const Eigen::VectorXd& residual,
                                       const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd root = whitened(model, residual, covariance).root;
  const ProjectedEvidence left = project(model, residual, covariance);
  // L B u, whose covariance L B B' L' is V - J Sigma J'.
  const Eigen::MatrixXd spread = root * left.basis.topRows(root.rows());
  const Eigen::ArrayXd variance = spread.rowwise().squaredNorm().array();
  return (variance > 1e-9 * covariance.diagonal().array())
      .select((spread * left.u).array() / variance.sqrt(),
              std::numeric_limits<double>::quiet_NaN());
}

std::vector<LeftOutExperiment> left_out_experiments(const LinearModel& model,
                                                    const Eigen::VectorXd& residual,
                                                    const Eigen::MatrixXd& covariance) {
  const ProjectedEvidence all = project(model, residual, covariance);
  std::vector<LeftOutExperiment> result;
  for (const std::string& experiment : experiments_of(model)) {
    const Misfit others = misfit_of(model, residual, covariance, rows_of(model, experiment, true));
    LeftOutExperiment left{experiment, all.u.squaredNorm() - others.chi_square,
                           static_cast<double>(all.nu()) - others.freedom, 1.0};
    left.tail_probability = chi_square_tail(left.statistic, left.freedom);
    result.push_back(left);
  }
  return result;
}

std::vector<TugOfWar> tugs_of_war(const LinearModel& model, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& covariance) {
  LinearModel alone = model;
  alone.prior_precision.resize(0);
  alone.prior_offset.resize(0);
  const std::vector<std::string> names = experiments_of(model);
  std::vector<TugOfWar> result;
  for (std::size_t a = 0; a < names.size(); ++a) {
    const std::vector<Eigen::Index> rows_a = rows_of(model, names[a]);
    const Misfit misfit_a = misfit_of(alone, residual, covariance, rows_a);
    for (std::size_t b = a + 1; b < names.size(); ++b) {
      std::vector<Eigen::Index> both = rows_of(model, names[b]);
      const Misfit misfit_b = misfit_of(alone, residual, covariance, both);
      both.insert(both.end(), rows_a.begin(), rows_a.end());
      const Misfit joint = misfit_of(alone, residual, covariance, both);
      TugOfWar tug{names[a], names[b], joint.chi_square - misfit_a.chi_square - misfit_b.chi_square,
                   joint.freedom - misfit_a.freedom - misfit_b.freedom, 1.0};
      tug.tail_probability = chi_square_tail(tug.statistic, tug.freedom);
      result.push_back(tug);
    }
  }
  return result;
}

std::vector<ParameterWish> parameter_wishes(const LinearModel& model,
                                            const Eigen::VectorXd& residual,
                                            const Eigen::MatrixXd& covariance) {
  const WhitenedEvidence w = whitened(model, residual, covariance);
  const ProjectedEvidence left = project(model, residual, covariance);
  const Eigen::VectorXd remaining = left.basis * left.u;
  std::vector<ParameterWish> wishes;
  for (const std::string& experiment : experiments_of(model)) {
    const std::vector<Eigen::Index> rows = rows_of(model, experiment);
    for (Eigen::Index j = 0; j < model.jacobian.cols(); ++j) {
      const Eigen::VectorXd slope = w.jacobian(rows, j);
      const double information = slope.squaredNorm();
      const double change = information > 0.0 ? slope.dot(remaining(rows)) / information : 0.0;
      wishes.push_back({experiment, j, change, 1.0 / std::sqrt(information)});
    }
  }
  return wishes;
}

}  // namespace tilth
