// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "bench/search/stand_in.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "calibrate/csv_table.hpp"
#include "calibrate/optimise_nlopt.hpp"
#include "calibrate/sobol_design.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace tilth::bench {
namespace {

using test::normal_number;
using test::scrambled;

constexpr std::uint64_t training_seed = 1;  // the packing the emulators are trained on
constexpr Eigen::Index constrained_modulus = 1;
constexpr double least_modulus_Pa = 2.6e5;  // see StandIn::fails()
constexpr double neighbour = 0.006;         // unit distance over which m moves less than chaos
constexpr std::uint64_t data_packings = 900'000'000;
constexpr int num_data_packings = 6;

struct Run {
  std::uint64_t seed = 0;
  Eigen::VectorXd unit;
  Eigen::VectorXd transformed;
};

Target target_of(const std::string& name, double sigma, bool log_transform) {
  Target target = test::log_target(name, 1.0, sigma);
  target.log_transform = log_transform;
  target.statistic = name;
  return target;
}

// Bounds and starts of data/soils/loamy_sand/parameters.csv, targets of its measurements.csv.
StandIn empty_stand_in() {
  StandIn stand_in;
  stand_in.parameters = {test::log_parameter("bond_modulus_Pa", 1e5, 5e7, 3e6),
                         test::log_parameter("bond_tensile_strength_Pa", 200.0, 1e5, 4000.0),
                         test::linear_parameter("friction", 0.05, 1.5, 0.5)};
  stand_in.targets = {target_of("friction_angle_rad", 0.05236, false),
                      target_of("constrained_modulus_Pa", 0.8, true),
                      target_of("unload_modulus_Pa", 0.7, true),
                      target_of("peak_stress_Pa", 1.1, true)};
  return stand_in;
}

std::vector<Run> read_runs(const std::filesystem::path& file, const StandIn& stand_in) {
  CsvColumns columns{{"seed"}, {}};
  for (const Parameter& p : stand_in.parameters) columns.required.push_back(p.name);
  for (const Target& t : stand_in.targets) columns.required.push_back(t.name);
  std::vector<std::string> problems;
  const CsvTable table = read_csv(file, columns, problems);
  std::vector<Run> runs;
  for (const CsvRow& row : table.rows) {
    CsvRowReader reader(table, row, problems);
    Run run;
    run.seed = static_cast<std::uint64_t>(reader.number("seed").value_or(0.0));
    run.unit.resize(static_cast<Eigen::Index>(stand_in.parameters.size()));
    run.transformed.resize(static_cast<Eigen::Index>(stand_in.targets.size()));
    for (std::size_t j = 0; j < stand_in.parameters.size(); ++j) {
      const Parameter& p = stand_in.parameters[j];
      const double value = std::clamp(reader.number(p.name).value_or(p.start), p.lower, p.upper);
      run.unit[static_cast<Eigen::Index>(j)] = unit_from_physical(p, value);
    }
    for (std::size_t k = 0; k < stand_in.targets.size(); ++k) {
      const Target& t = stand_in.targets[k];
      run.transformed[static_cast<Eigen::Index>(k)] =
          transformed(t, reader.number(t.name).value_or(1.0));
    }
    runs.push_back(std::move(run));
  }
  if (!problems.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(problems, "\n")));
  return runs;
}

// Variance of T between packings at one parameter set, pooled over the sets run on several.
Eigen::VectorXd variance_between_packings(const std::vector<Run>& runs) {
  std::map<std::vector<double>, std::vector<const Run*>> sets;
  for (const Run& run : runs) sets[{run.unit.begin(), run.unit.end()}].push_back(&run);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(runs.front().transformed.size());
  double freedom = 0.0;
  for (const auto& [unit, members] : sets) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(sum.size());
    for (const Run* run : members) mean += run->transformed / static_cast<double>(members.size());
    for (const Run* run : members) sum += (run->transformed - mean).cwiseAbs2();
    freedom += static_cast<double>(members.size() - 1);
  }
  return sum / freedom;
}

// Half the mean squared difference of pairs too close to differ by their parameters.
Eigen::VectorXd variance_between_neighbours(const std::vector<Run>& runs) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(runs.front().transformed.size());
  int num_pairs = 0;
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double distance = (runs[a].unit - runs[b].unit).lpNorm<Eigen::Infinity>();
      if (runs[a].seed != runs[b].seed || distance > neighbour || distance == 0.0) continue;
      sum += 0.5 * (runs[a].transformed - runs[b].transformed).cwiseAbs2();
      ++num_pairs;
    }
  }
  if (num_pairs == 0) throw std::runtime_error("no neighbouring runs to measure chaos on");
  return sum / num_pairs;
}

void train(StandIn& stand_in, const std::vector<Run>& runs) {
  std::vector<const Run*> used;
  for (const Run& run : runs) {
    if (run.seed == training_seed) used.push_back(&run);
  }
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd points(runs.front().unit.size(), n);
  Eigen::MatrixXd values(runs.front().transformed.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    points.col(i) = used[static_cast<std::size_t>(i)]->unit;
    values.col(i) = used[static_cast<std::size_t>(i)]->transformed;
  }
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    stand_in.emulators.emplace_back(points, values.row(k).transpose(), EmulatorOptions{});
  }
  stand_in.num_training_runs = used.size();
}

double noise_free_minimum(const StandIn& stand_in, const Twin& twin) {
  const auto objective = [&](const Eigen::VectorXd& unit) {
    return noise_free_chi_square(stand_in, twin, unit);
  };
  const Eigen::Index d = twin.truth.size();
  const Eigen::MatrixXd design = sobol_points(4096, static_cast<int>(d));
  std::vector<std::pair<double, Eigen::VectorXd>> starts{{objective(twin.truth), twin.truth}};
  for (const auto& unit : design.colwise()) starts.emplace_back(objective(unit), unit);
  std::sort(starts.begin(), starts.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  double least = starts.front().first;
  for (std::size_t i = 0; i < 8; ++i) {
    const NloptResult found =
        minimise_with_nlopt(objective, Eigen::VectorXd::Zero(d), Eigen::VectorXd::Ones(d),
                            starts[i].second, {NloptAlgorithm::sbplx, 1000, 1e-6, 1});
    least = std::min(least, found.value);
  }
  return least;
}

}  // namespace

Eigen::VectorXd StandIn::mean(const Eigen::VectorXd& unit) const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(emulators.size()));
  for (std::size_t k = 0; k < emulators.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = emulators[k].predict_mean(unit);
  }
  return result;
}

bool StandIn::fails(const Eigen::VectorXd& mean) {
  return mean[constrained_modulus] < std::log(least_modulus_Pa);
}

Eigen::VectorXd StandIn::variance() const { return packing_sd.cwiseAbs2() + chaos_sd.cwiseAbs2(); }

Evaluation StandIn::run(const Eigen::VectorXd& physical, std::uint64_t seed,
                        std::uint64_t stream) const {
  if (grains) return grains(physical, std::span(&seed, 1)).front();
  Eigen::VectorXd unit(physical.size());
  std::uint64_t place = scrambled(stream);
  for (Eigen::Index j = 0; j < unit.size(); ++j) {
    unit[j] = unit_from_physical(parameters[static_cast<std::size_t>(j)], physical[j]);
    place = scrambled(place ^ std::bit_cast<std::uint64_t>(physical[j]));
  }
  const Eigen::VectorXd m = mean(unit);
  if (fails(m)) return {EvaluationStatus::failed, {}, "the soil is too soft for the oedometer"};
  Eigen::VectorXd features(m.size());
  for (Eigen::Index k = 0; k < m.size(); ++k) {
    const auto index = static_cast<std::uint64_t>(k);
    const double value = m[k] + packing_sd[k] * normal_number(stream, seed, index) +
                         chaos_sd[k] * normal_number(place, seed, index);
    features[k] = untransformed(targets[static_cast<std::size_t>(k)], value);
  }
  return {EvaluationStatus::completed, features, ""};
}

StandIn read_stand_in(const std::filesystem::path& file) {
  StandIn stand_in = empty_stand_in();
  const std::vector<Run> runs = read_runs(file, stand_in);
  train(stand_in, runs);
  const Eigen::VectorXd chaos = variance_between_neighbours(runs);
  stand_in.chaos_sd = chaos.cwiseSqrt();
  stand_in.packing_sd = (variance_between_packings(runs) - chaos).cwiseMax(0.0).cwiseSqrt();
  return stand_in;
}

Twin make_twin(const StandIn& stand_in, const Eigen::VectorXd& noise, std::uint64_t stream) {
  Twin twin{stream, Eigen::VectorXd(3), stand_in.targets, 0.0};
  std::uint64_t word = scrambled(stream ^ 0x7417ULL);
  do {
    for (double& u : twin.truth) {
      word = scrambled(word);
      u = 0.15 + 0.7 * static_cast<double>(word >> 11) * 0x1p-53;
    }
  } while (StandIn::fails(stand_in.mean(twin.truth)));

  Eigen::VectorXd data = Eigen::VectorXd::Zero(noise.size());
  for (int i = 0; i < num_data_packings; ++i) {
    const Evaluation run = stand_in.run(physical_point(stand_in.parameters, twin.truth),
                                        data_packings + static_cast<std::uint64_t>(i), stream);
    if (run.status != EvaluationStatus::completed)
      throw std::runtime_error("the truth itself fails: " + run.message);
    for (Eigen::Index k = 0; k < data.size(); ++k) {
      data[k] += transformed(twin.targets[static_cast<std::size_t>(k)], run.features[k]) /
                 num_data_packings;
    }
  }
  const Eigen::VectorXd variance = stand_in.variance() / num_data_packings;
  for (Eigen::Index k = 0; k < data.size(); ++k) {
    Target& target = twin.targets[static_cast<std::size_t>(k)];
    const double error = noise[k] * normal_number(stream, 77, static_cast<std::uint64_t>(k));
    target.value = untransformed(target, data[k] + error);
    target.sigma = std::hypot(noise[k], std::sqrt(variance[k]));
  }
  twin.least = noise_free_minimum(stand_in, twin);
  return twin;
}

Simulator simulator_of(const StandIn& stand_in, const Twin& twin) {
  return [&](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    if (stand_in.grains) return stand_in.grains(parameters, seeds);
    std::vector<Evaluation> runs;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      runs.push_back(
          stand_in.run(parameters.col(i), seeds[static_cast<std::size_t>(i)], twin.stream));
    }
    return runs;
  };
}

Eigen::VectorXd residuals_of(const StandIn& stand_in, const Twin& twin, const Eigen::VectorXd& mean,
                             int num_packings) {
  const Eigen::VectorXd variance = stand_in.variance() / num_packings;
  Eigen::VectorXd residuals(mean.size());
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    const Target& target = twin.targets[static_cast<std::size_t>(k)];
    residuals[k] = (mean[k] - transformed(target, target.value)) /
                   std::hypot(target.sigma, std::sqrt(variance[k]));
  }
  return residuals;
}

double noise_free_chi_square(const StandIn& stand_in, const Twin& twin,
                             const Eigen::VectorXd& unit) {
  const Eigen::VectorXd mean = stand_in.mean(unit);
  if (StandIn::fails(mean)) return std::numeric_limits<double>::infinity();
  return residuals_of(stand_in, twin, mean, 1).squaredNorm();
}

}  // namespace tilth::bench
