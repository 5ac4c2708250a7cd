// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/measured_features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "calibrate/nearest_name.hpp"
#include "calibrate/regression.hpp"
#include "experiments/triaxial_features.hpp"

namespace tilth {
namespace {

constexpr double last_share_of_strain = 0.01;  ///< a peak this near the end is no peak
constexpr std::size_t least_curves = 8;        ///< four coefficients and four degrees of freedom

struct FeaturedCurve {
  const MeasuredCurve* curve = nullptr;
  double cell_pressure_Pa = 0.0;
  double relative_density = 0.0;
  std::map<std::string, double> features;
  bool peaks_at_end = false;
};

std::vector<FeaturedCurve> read_features(const SoilData& soil) {
  std::vector<FeaturedCurve> curves;
  std::vector<std::string> problems;
  for (const MeasuredCurve& c : soil.curves) {
    if (c.test_id != "drained_triaxial") continue;
    const TestCondition& condition = *soil.condition(c.condition_id);
    const auto density = condition.number("relative_density");
    const std::vector<Feature> found = triaxial_features({c.condition_id, c.columns, c.rows});
    if (!density)
      problems.push_back(fmt::format("conditions.csv:{}: condition '{}' needs relative_density: the "
                                     "scatter is taken about a regression on it",
                                     condition.line, condition.id));
    if (found.empty())
      problems.push_back(fmt::format("curves.csv:{}: the curve of '{}' ends before 4 % of axial "
                                     "strain or has fewer than 10 rows",
                                     c.line, c.condition_id));
    if (!density || found.empty()) continue;
    FeaturedCurve f{&c, *condition.number("cell_pressure_Pa"), *density, {}, false};
    for (const Feature& feature : found) f.features[feature.name] = feature.value;
    f.peaks_at_end =
        f.features.at("strain_at_peak") >= c.rows.back().front() - last_share_of_strain;
    curves.push_back(std::move(f));
  }
  if (problems.empty() && curves.size() < least_curves)
    problems.push_back(fmt::format("{}: {} drained triaxial curves; at least {} are needed for the "
                                   "scatter about a regression",
                                   soil.folder.string(), curves.size(), least_curves));
  if (!problems.empty()) throw ConfigError(problems);
  return curves;
}

bool is_logged(const std::string& feature) { return feature == "initial_modulus_Pa"; }

bool counts(const FeaturedCurve& c, const std::string& feature) {
  return feature != "strain_at_peak" || !c.peaks_at_end;
}

double scatter_of(const std::vector<FeaturedCurve>& curves, const std::string& feature) {
  std::vector<const FeaturedCurve*> used;
  for (const FeaturedCurve& c : curves)
    if (counts(c, feature)) used.push_back(&c);
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd x(n, 4);
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const FeaturedCurve& c = *used[static_cast<std::size_t>(k)];
    x.row(k) << 1.0, c.relative_density, c.relative_density * c.relative_density,
        std::log(c.cell_pressure_Pa);
    y[k] = is_logged(feature) ? std::log(c.features.at(feature)) : c.features.at(feature);
  }
  try {
    return regress(x, y).scatter;
  } catch (const std::invalid_argument& e) {
    throw ConfigError({fmt::format("{}: {}", feature, e.what())});
  }
}

void check_ids(const SoilData& soil, const std::vector<std::string>& fitted) {
  std::vector<std::string> known, problems;
  for (const MeasuredCurve& c : soil.curves) known.push_back(c.condition_id);
  for (const std::string& id : fitted)
    if (std::ranges::find(known, id) == known.end())
      problems.push_back(unknown_name_sentence("condition with a curve", id, known));
  if (!problems.empty()) throw ConfigError(problems);
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

}  // namespace

std::vector<SoilTarget> features_of_curves(const SoilData& soil,
                                           const std::vector<std::string>& fitted,
                                           const std::string& source) {
  check_ids(soil, fitted);
  const std::vector<FeaturedCurve> curves = read_features(soil);
  constexpr const char* names[] = {"initial_modulus_Pa", "peak_stress_ratio", "strain_at_peak",
                                   "end_stress_ratio", "dilation_rate", "final_volumetric_strain"};
  std::map<std::string, double> scatter;
  for (const char* name : names) scatter[name] = scatter_of(curves, name);
  std::vector<SoilTarget> targets;
  for (const FeaturedCurve& c : curves)
    for (const std::string name : names) {
      if (!counts(c, name)) continue;
      SoilTarget t;
      t.test_id = "drained_triaxial";
      t.observable_id = name;
      t.condition_id = c.curve->condition_id;
      t.value = c.features.at(name);
      t.sigma = scatter.at(name);
      t.sigma_kind = is_logged(name) ? SigmaKind::log : SigmaKind::absolute;
      t.holdout = std::ranges::find(fitted, c.curve->condition_id) == fitted.end();
      t.origin = {Provenance::measured, source,
                  fmt::format("curve of {} (curves.csv), read by triaxial_features(); sigma: scatter "
                              "about a regression on relative density, its square and ln(cell "
                              "pressure) over {} tests, there are no repeats",
                              c.curve->condition_id, curves.size())};
      if (c.peaks_at_end && name.ends_with("_stress_ratio"))
        t.observation_groups = {c.curve->condition_id + "_last_stress_ratio"};
      targets.push_back(std::move(t));
    }
  return targets;
}

std::string measurements_csv(const std::vector<SoilTarget>& targets) {
  std::string text =
      "testId,observableId,conditionId,xId,x,value,sigma,sigma_kind,replicateId,weight,holdout,"
      "provenance,observation_group,source,locator\n";
  for (const SoilTarget& t : targets)
    text += fmt::format("{},{},{},,,{:.6g},{:.4g},{},{},1,{},{},{},{},{}\n", t.test_id,
                        t.observable_id, t.condition_id, t.value, t.sigma,
                        sigma_kind_words()[static_cast<std::size_t>(t.sigma_kind)], t.replicate_id,
                        t.holdout ? 1 : 0, to_string(t.origin.provenance),
                        fmt::join(t.observation_groups, ";"), quoted(t.origin.source),
                        quoted(t.origin.locator));
  return text;
}

}  // namespace tilth
