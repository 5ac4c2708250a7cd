// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/optimise_nlopt.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlopt.hpp>
#include <vector>

namespace tilth {
namespace {

nlopt::algorithm algorithm_of(NloptAlgorithm algorithm) {
  switch (algorithm) {
    case NloptAlgorithm::direct_l:
      return nlopt::GN_DIRECT_L;
    case NloptAlgorithm::crs2:
      return nlopt::GN_CRS2_LM;
    case NloptAlgorithm::isres:
      return nlopt::GN_ISRES;
    case NloptAlgorithm::sbplx:
      return nlopt::LN_SBPLX;
    case NloptAlgorithm::bobyqa:
      return nlopt::LN_BOBYQA;
  }
  return nlopt::LN_SBPLX;
}

std::vector<double> to_std(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }

// The objective as NLopt calls it; keeps the best point and shields NLopt from non-finite values.
struct Recorder {
  const std::function<double(const Eigen::VectorXd&)>& objective;
  NloptResult result;
  double worst = 0.0;
  std::exception_ptr thrown;

  double evaluate(const Eigen::VectorXd& x) {
    ++result.num_evaluations;
    const double value = objective(x);
    if (!std::isfinite(value)) return worst;
    if (!std::isfinite(result.value) || value < result.value) {
      result.x = x;
      result.value = value;
    }
    worst = std::max(worst, value);
    return value;
  }

  static double call(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* self) {
    auto& recorder = *static_cast<Recorder*>(self);
    try {
      return recorder.evaluate(
          Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
    } catch (...) {
      recorder.thrown = std::current_exception();
      throw nlopt::forced_stop();
    }
  }
};

void run(nlopt::opt& search, std::vector<double> x, Recorder& recorder) {
  double value = 0.0;
  try {
    const nlopt::result code = search.optimize(x, value);
    recorder.result.converged = code == nlopt::XTOL_REACHED;
    recorder.result.message = code == nlopt::XTOL_REACHED      ? "step tolerance reached"
                              : code == nlopt::MAXEVAL_REACHED ? "evaluation limit reached"
                                                               : "finished";
  } catch (const std::exception& error) {  // rounding trouble and the like: the best point stays
    recorder.result.message = error.what();
  }
  if (recorder.thrown) std::rethrow_exception(recorder.thrown);
}

}  // namespace

NloptResult minimise_with_nlopt(const std::function<double(const Eigen::VectorXd&)>& objective,
                                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const Eigen::VectorXd& start, const NloptOptions& options) {
  Recorder recorder{objective, {}, 0.0, nullptr};
  recorder.result.x = start;
  recorder.result.value = std::numeric_limits<double>::quiet_NaN();
  const double start_value = recorder.evaluate(start);
  if (!std::isfinite(recorder.result.value)) {
    recorder.result.message = "the objective is not finite at the start";
    return recorder.result;
  }
  recorder.worst = start_value;

  nlopt::srand(static_cast<unsigned long>(options.seed));
  nlopt::opt search(algorithm_of(options.algorithm), static_cast<unsigned>(start.size()));
  search.set_lower_bounds(to_std(lower));
  search.set_upper_bounds(to_std(upper));
  search.set_xtol_abs(to_std(options.xtol * (upper - lower)));
  search.set_maxeval(options.max_evaluations);
  search.set_min_objective(&Recorder::call, &recorder);
  run(search, to_std(start), recorder);
  return recorder.result;
}

}  // namespace tilth
