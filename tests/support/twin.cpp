// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/twin.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "calibrate/cli/run_config.hpp"
#include "calibrate/soil_fit.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace tilth::test {
namespace {

constexpr std::uint64_t first_data_seed = 50'001;  // a fit of seed s uses s ... s + 2999

SoilTarget target(const std::string& test, const std::string& observable,
                  const std::string& condition, double sigma) {
  SoilTarget t;
  t.test_id = test;
  t.observable_id = observable;
  t.condition_id = condition;
  t.value = 1.0;
  t.sigma = sigma;
  const bool angle = observable.ends_with("_rad");
  t.sigma_kind = angle ? SigmaKind::absolute : SigmaKind::log;
  t.origin = {Provenance::synthetic, "twin experiment", "tests/support/twin.cpp"};
  t.observation_groups = {test + "/" + observable + "/" + condition};
  return t;
}

std::vector<SoilTarget> targets_of(const TwinSpec& spec) {
  const double s = spec.relative_noise;
  std::vector<SoilTarget> all = {
      target("unconfined_compression", "peak_stress_Pa", "unconfined_drained", s),
      target("unconfined_compression", "secant_modulus_Pa", "unconfined_drained", s),
      target("confined_compression", "constrained_modulus_Pa", "compression_25_100_kPa", s),
      target("confined_compression", "unload_modulus_Pa", "compression_25_100_kPa", s)};
  if (spec.line) {
    all.push_back(target("direct_shear", "cohesion_Pa", "shear_drained", s));
    all.push_back(
        target("direct_shear", "friction_angle_rad", "shear_drained", spec.angle_noise_rad));
  } else {
    all.push_back(target("direct_shear", "peak_shear_stress_Pa", "shear_drained_10_kPa", s));
    all.push_back(target("direct_shear", "peak_shear_stress_Pa", "shear_drained_40_kPa", s));
  }
  return all;
}

// The truth as one column of parameters.csv.
Eigen::VectorXd truth_values(const SoilData& soil, const TwinTruth& truth) {
  Eigen::VectorXd values = nominal_values(soil);
  for (std::size_t k = 0; k < soil.parameters.size(); ++k) {
    const std::string& id = soil.parameters[k].id;
    double& value = values[static_cast<Eigen::Index>(k)];
    if (id == "bond_modulus_Pa") value = truth.bond_modulus_Pa;
    if (id == "bond_tensile_strength_Pa") value = truth.bond_tensile_strength_Pa;
    if (id == "friction") value = truth.friction;
  }
  return values;
}

// Transformed features of the truth. @shape (num_targets, num_data_packings)
Eigen::MatrixXd measure(const SoilData& soil, const TwinSpec& spec, const RunContext& context) {
  const std::vector<Target> targets = fit_targets(soil);
  const Simulator laboratory = dem_simulator(soil, spec.data, context);
  const Eigen::VectorXd truth = truth_values(soil, spec.truth);
  Eigen::MatrixXd samples(static_cast<Eigen::Index>(targets.size()), spec.num_data_packings);
  for (int n = 0; n < spec.num_data_packings; ++n) {
    const Evaluation run = laboratory(truth, std::array{first_data_seed + static_cast<std::uint64_t>(n)}).front();
    if (run.status != EvaluationStatus::completed)
      throw std::runtime_error("the truth itself fails: " + run.message);
    for (std::size_t k = 0; k < targets.size(); ++k)
      samples(static_cast<Eigen::Index>(k), n) =
          transformed(targets[k], run.features[static_cast<Eigen::Index>(k)]);
  }
  return samples;
}

}  // namespace

SoilData twin_soil(const TwinSpec& spec, const RunContext& context) {
  SoilData soil = load_soil(std::string(TILTH_SOURCE_DIR) + "/data/soils/loamy_sand");
  soil.targets = targets_of(spec);
  soil.superseded.clear();
  const Eigen::MatrixXd samples = measure(soil, spec, context);
  const Eigen::VectorXd mean = samples.rowwise().mean();
  const std::vector<Target> targets = fit_targets(soil);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double variance =
        (samples.row(row).array() - mean[row]).square().sum() / (spec.num_data_packings - 1.0);
    const double noise = soil.targets[k].sigma * normal_number(spec.noise_stream, 1, k);
    soil.targets[k].value = untransformed(targets[k], mean[row] + noise);
    soil.targets[k].sigma =
        std::sqrt(soil.targets[k].sigma * soil.targets[k].sigma + variance / spec.num_data_packings);
  }
  return soil;
}

TwinResult run_twin(const TwinSpec& spec, const RunContext& context) {
  const SoilData soil = twin_soil(spec, context);
  const Eigen::VectorXd truth = truth_values(soil, spec.truth);
  const Simulator search = dem_simulator(soil, spec.search, context);
  const Simulator confirm = dem_simulator(soil, spec.confirm.value_or(spec.search), context);
  TwinResult result;
  result.summary = fit(fit_parameters(soil), fit_targets(soil), search,
                       spec.confirm ? &confirm : nullptr, spec.options);
  for (std::size_t k = 0; k < result.summary.parameters.size(); ++k) {
    const FittedParameter& p = result.summary.parameters[k];
    if (!p.estimate) continue;
    const double true_value = truth[static_cast<Eigen::Index>(k)];
    const bool inside = p.lo95 <= true_value && true_value <= p.hi95;
    result.parameters.push_back({p.name, true_value, p.value, p.lo95, p.hi95, inside});
    result.num_inside += inside ? 1 : 0;
  }
  return result;
}

std::vector<TwinCase> documented_twins() {
  FitOptions options;  // smaller than the program's own: five fits in a quarter of an hour
  options.num_design = 15;
  options.num_search_seeds = 2;
  options.num_confirm_seeds = 3;
  options.num_fresh_seeds = 3;
  options.num_rounds = 1;
  options.num_starts = 2;
  options.max_iterations = 5;
  options.max_bias_rounds = 1;
  options.chi_square_tolerance = 0.1;
  const auto twin = [&](TwinTruth truth, std::uint64_t stream) {
    return TwinSpec{.truth = truth, .noise_stream = stream, .options = options};
  };
  std::vector<TwinCase> cases = {{"soft, weak", twin({1.5e6, 3e3, 0.35}, 11)},
                                 {"stiff, strong", twin({8e6, 15e3, 0.6}, 12)},
                                 {"stiff, weak", twin({6e6, 4e3, 0.25}, 13)},
                                 {"line", twin({3e6, 8e3, 0.45}, 14)},
                                 {"other size", twin({3e6, 6e3, 0.4}, 15)}};
  cases[3].spec.line = true;
  cases[4].spec.data = Fidelity::search;
  cases[4].spec.confirm = Fidelity::search;
  return cases;
}

std::string twin_table(const std::string& name, const TwinResult& result) {
  std::string text;
  for (const TwinParameter& p : result.parameters)
    text += fmt::format("| {} | {} | {:.4g} | {:.4g} | {:.4g} to {:.4g} | {} |\n", name, p.name,
                        p.truth, p.value, p.lo95, p.hi95, p.inside ? "yes" : "no");
  const FitSummary& s = result.summary;
  text += fmt::format("| {} | {} | chi-square {:.2f}, fresh {:.2f} | {} targets | {} simulations | "
                      "{} failed |\n",
                      name, to_string(s.termination), s.chi_square, s.chi_square_fresh,
                      s.targets.size(), s.num_simulations, s.failures.size());
  return text;
}

double chi_square_quantile(double normal_quantile, int freedom) {
  const double part = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1.0 - part + normal_quantile * std::sqrt(part), 3.0);
}

}  // namespace tilth::test
