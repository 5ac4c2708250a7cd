// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/scale_series.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tilth {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
bool has_feature(const ExperimentResult& r, const std::string& name) {
  return std::ranges::find(r.features, name, &Feature::name) != r.features.end();
}

std::vector<double> values_of(const ScaleSize& size, const std::string& feature) {
  std::vector<double> values;
  for (const ExperimentResult& r : size.runs) values.push_back(r.feature(feature));
  return values;
}

/// A depth and a distance from the path, with tracers on one side of it or on both.
struct Site {
  double depth_m = 0.0;
  std::vector<double> lateral_m;
};

bool answered(const std::vector<ScaleSize>& sizes, double depth_m, double lateral_m) {
  const std::string name = "forward_displacement_m@" + tracer_label(depth_m, lateral_m);
  return std::ranges::all_of(sizes, [&](const ScaleSize& size) {
    return std::ranges::all_of(size.runs, [&](const auto& r) { return has_feature(r, name); });
  });
}

/// Sites whose tracers every run has. The sweep is its own mirror image, so both sides of its path are one site.
std::vector<Site> common_sites(const ScaleSeries& series, const std::vector<ScaleSize>& sizes) {
  std::vector<Site> sites;
  for (const double depth_m : series.config.tracer_depth_m)
    for (const double lateral_m : series.config.tracer_lateral_m) {
      if (!answered(sizes, depth_m, lateral_m)) continue;
      const auto mirrored = std::ranges::find_if(sites, [&](const Site& s) {
        return s.depth_m == depth_m && s.lateral_m.front() == -lateral_m;
      });
      if (mirrored != sites.end())
        mirrored->lateral_m.push_back(lateral_m);
      else
        sites.push_back({depth_m, {lateral_m}});
    }
  return sites;
}

/// Forward, outward and upward displacement of every site; outward is 0 on the path itself.
Eigen::VectorXd displacement_of(const ExperimentResult& run, const std::vector<Site>& sites) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * sites.size()));
  Eigen::Index k = 0;
  for (const Site& site : sites) {
    const auto n = static_cast<double>(site.lateral_m.size());
    for (const double lateral_m : site.lateral_m) {
      const std::string at = "@" + tracer_label(site.depth_m, lateral_m);
      const double outward = lateral_m > 0 ? 1.0 : lateral_m < 0 ? -1.0 : 0.0;
      u[k] += run.feature("forward_displacement_m" + at) / n;
      u[k + 1] += outward * run.feature("lateral_displacement_m" + at) / n;
      u[k + 2] += run.feature("vertical_displacement_m" + at) / n;
    }
    k += 3;
  }
  return u;
}

/// ln(density) = a + b ln(radius) by least squares.
struct PowerLaw {
  Eigen::Vector2d coefficients;
  explicit PowerLaw(const std::vector<Drift>& density) {
    Eigen::MatrixX2d x(density.size(), 2);
    Eigen::VectorXd y(density.size());
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      const Drift& d = density[static_cast<std::size_t>(k)];
      x.row(k) << 1.0, std::log(d.radius_m);
      y[k] = std::log(d.mean);
    }
    coefficients = x.colPivHouseholderQr().solve(y);
  }
  double at(double radius_m) const { return std::exp(coefficients[0] + coefficients[1] * std::log(radius_m)); }
};

void study(double tolerance, ScaleResult& result) {
  if (result.sizes.size() < 2) {
    result.no_study = "fewer than two sizes have two packings that completed";
    return;
  }
  const std::vector<Site> sites = common_sites(result.series, result.sizes);
  result.num_sites = static_cast<int>(sites.size());
  if (sites.empty()) {
    result.no_study = "no tracer site is in the steady stretch of every run";
    return;
  }
  std::vector<SizeAnswers> answers;
  std::vector<double> radii_m;
  std::vector<std::vector<double>> draught, density;
  for (const ScaleSize& size : result.sizes) {
    SizeAnswers answer{size.radius_m, {}};
    for (const ExperimentResult& run : size.runs) answer.displacement_m.push_back(displacement_of(run, sites));
    answers.push_back(std::move(answer));
    radii_m.push_back(size.radius_m);
    draught.push_back(values_of(size, "draught_N"));
    density.push_back(values_of(size, "contact_density_per_m2"));
  }
  try {
    result.study = study_scale(answers, tolerance);
  } catch (const std::invalid_argument& e) {
    result.no_study = e.what();
    return;
  }
  result.draught = drift_of(radii_m, draught);
  result.contact_density = drift_of(radii_m, density);
  const PowerLaw law(result.contact_density);
  const ScaleLimit& limit = result.study.limit;
  result.density_at_limit = law.at(limit.radius_m);
  result.density_hi95 = std::isfinite(limit.lo95_m) ? law.at(limit.lo95_m) : not_known;
  result.density_lo95 = limit.hi95_m ? law.at(*limit.hi95_m) : not_known;
}

}  // namespace

SweepTillageConfig at_radius(const ScaleSeries& series, double radius_m, std::uint64_t packing_seed) {
  SweepTillageConfig config = series.config;
  config.particle_radius_m = radius_m;
  config.packing_seed = packing_seed;
  return config;
}

std::vector<ScaleResult> run_scale(const std::vector<ScaleSeries>& series,
                                   const std::vector<double>& radii_m, int num_packings,
                                   std::uint64_t first_seed, double tolerance, const RunContext& context) {
  std::vector<double> sorted_m = radii_m;
  std::ranges::sort(sorted_m);
  std::vector<TestRun> runs;
  for (const double radius_m : sorted_m)
    for (const ScaleSeries& s : series)
      for (int p = 0; p < num_packings; ++p)
        runs.push_back({at_radius(s, radius_m, first_seed + static_cast<std::uint64_t>(p)), s.name, s.material});
  const std::vector<ExperimentResult> answers = run_tests(runs, context);
  std::vector<ScaleResult> results(series.size());
  for (std::size_t k = 0; k < series.size(); ++k) results[k].series = series[k];
  std::size_t at = 0;
  for (const double radius_m : sorted_m)
    for (ScaleResult& result : results) {
      ScaleSize size{radius_m, num_aggregates(at_radius(result.series, radius_m, first_seed)), {}, {}};
      for (int p = 0; p < num_packings; ++p, ++at) {
        const ExperimentResult& r = answers[at];
        if (r.status == RunStatus::completed)
          size.runs.push_back(r);
        else
          size.failures.push_back(fmt::format("packing {}: {}: {}", first_seed + static_cast<std::uint64_t>(p),
                                              name_of(r.status), r.message));
      }
      (size.runs.size() < 2 ? result.left_out : result.sizes).push_back(std::move(size));
    }
  for (ScaleResult& result : results) study(tolerance, result);
  return results;
}

}  // namespace tilth
