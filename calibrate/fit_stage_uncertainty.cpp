// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <cmath>

#include "calibrate/fit_stages.hpp"

namespace tilth {
namespace {

// Covariance of the residuals at the optimum: 1 on the diagonal; between targets what one packing
// does to both; priors are independent.
Eigen::MatrixXd residual_covariance(const FitContext& context) {
  const int num_seeds = context.optimum->num_seeds;
  const Eigen::VectorXd sigmas = fitted_sigmas(context, num_seeds);
  const Eigen::VectorXd variance = model_variance(context, num_seeds);
  const Eigen::Index n = sigmas.size();
  const Eigen::Index total = n + static_cast<Eigen::Index>(num_priors(context));
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(total, total);
  Eigen::VectorXd share(n);  // of the packings in sigma_total
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(context.fitted[static_cast<std::size_t>(i)]);
    share[i] = std::sqrt(variance[k]) / sigmas[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i != j) covariance(i, j) = context.seed_correlation(i, j) * share[i] * share[j];
    }
  }
  return covariance;
}

// Share of the targets' own sigma in the variance of each residual; 1 for priors.
Eigen::VectorXd target_shares(const FitContext& context) {
  const Eigen::VectorXd sigmas = fitted_sigmas(context, context.optimum->num_seeds);
  Eigen::VectorXd shares =
      Eigen::VectorXd::Ones(sigmas.size() + static_cast<Eigen::Index>(num_priors(context)));
  for (Eigen::Index i = 0; i < sigmas.size(); ++i) {
    const double sigma = context.targets[context.fitted[static_cast<std::size_t>(i)]].sigma;
    shares[i] = sigma * sigma / (sigmas[i] * sigmas[i]);
  }
  return shares;
}

}  // namespace

void update_uncertainty(FitContext& context) {
  context.secants.reset();
  context.uncertainty.reset();
  if (!context.optimum || !context.optimum->from_local_search) return;
  const double scale = sigma_scale(context);
  if (std::isnan(scale)) return;
  context.secants = search_derivatives_at(context, context.optimum->unit);
  if (!context.secants) return;
  Eigen::MatrixXd noise = noise_in_products(context, *context.secants);
  Eigen::MatrixXd jacobian =
      residual_jacobian(context, context.secants->jacobian, context.optimum->num_seeds);
  if (context.options.rescale_sigma) {
    jacobian /= scale;
    noise /= scale * scale;
  }
  context.uncertainty = linear_uncertainty(jacobian, residual_covariance(context),
                                           derivative_error_share(context.options), noise);
}

Eigen::VectorXd errors_from_packings(const FitContext& context) {
  Eigen::MatrixXd packings = residual_covariance(context);
  packings.diagonal() -= target_shares(context);
  const Eigen::MatrixXd& gain = context.uncertainty->gain;
  return (gain * packings * gain.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

Eigen::VectorXd errors_from_targets(const FitContext& context) {
  const Eigen::MatrixXd& gain = context.uncertainty->gain;
  return (gain.cwiseAbs2() * target_shares(context)).cwiseSqrt();
}

}  // namespace tilth
