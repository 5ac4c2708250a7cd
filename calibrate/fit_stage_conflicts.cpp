// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include <algorithm>
#include <cmath>

#include "calibrate/emulator.hpp"
#include "calibrate/fit_stages.hpp"
#include "calibrate/sobol_design.hpp"

namespace tilth {
namespace {

constexpr int num_probes = 512;

// |residual| of every fitted target (rows) at points spread over the parameter box (columns), and
// at the optimum itself.
Eigen::MatrixXd emulated_misfits(const FitContext& context,
                                 const std::vector<Emulator>& emulators) {
  const auto num_free = static_cast<int>(context.free.size());
  const Eigen::MatrixXd probes = shifted_sobol_points(num_probes, num_free, context.options.seed);
  const Eigen::VectorXd sigmas = fitted_sigmas(context, 1);
  Eigen::MatrixXd misfit(sigmas.size(), probes.cols() + 1);
  for (Eigen::Index i = 0; i < sigmas.size(); ++i) {
    const std::size_t target = context.fitted[static_cast<std::size_t>(i)];
    const auto k = static_cast<Eigen::Index>(target);
    const double wanted = transformed(context.targets[target], context.targets[target].value);
    const auto distance = [&](double mean) {
      return std::abs(mean + context.bias[k] - wanted) / sigmas[i];
    };
    for (Eigen::Index c = 0; c < probes.cols(); ++c)
      misfit(i, c) = distance(emulators[static_cast<std::size_t>(i)].predict_mean(probes.col(c)));
    misfit(i, probes.cols()) = distance(context.optimum->mean[k]);
  }
  return misfit;
}

}  // namespace

void find_conflicts(FitContext& context) {
  if (!context.optimum) return;
  const std::vector<Emulator>& emulators = final_emulators(context);
  if (emulators.empty()) return;
  const Eigen::MatrixXd misfit = emulated_misfits(context, emulators);
  const Eigen::VectorXd alone = misfit.rowwise().minCoeff();
  auto& found = context.summary.conflicts;
  for (Eigen::Index a = 0; a < misfit.rows(); ++a) {
    if (alone[a] > conflict_limit) continue;
    for (Eigen::Index b = a + 1; b < misfit.rows(); ++b) {
      if (alone[b] > conflict_limit) continue;
      const double together = misfit.row(a).cwiseMax(misfit.row(b)).minCoeff();
      if (together <= conflict_limit) continue;
      const Target& first = context.targets[context.fitted[static_cast<std::size_t>(a)]];
      const Target& second = context.targets[context.fitted[static_cast<std::size_t>(b)]];
      found.push_back({first.name, second.name, together,
                       !first.statistic.empty() && first.statistic == second.statistic});
    }
  }
  std::ranges::stable_sort(found, std::greater(), &TargetConflict::misfit);
}

}  // namespace tilth
