// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "tests/calibrate/nist_problems.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace tilth::test {
namespace {

using Real = long double;
using Model = std::function<Real(const Real* b, Real x1, Real x2)>;
constexpr Real pi = std::numbers::pi_v<Real>;

Real square(Real v) { return v * v; }

Real misra1a(const Real* b, Real x, Real) { return b[0] * (1 - std::exp(-b[1] * x)); }
Real misra1b(const Real* b, Real x, Real) { return b[0] * (1 - 1 / square(1 + b[1] * x / 2)); }
Real misra1c(const Real* b, Real x, Real) { return b[0] * (1 - 1 / std::sqrt(1 + 2 * b[1] * x)); }
Real misra1d(const Real* b, Real x, Real) { return b[0] * b[1] * x / (1 + b[1] * x); }
Real chwirut(const Real* b, Real x, Real) { return std::exp(-b[0] * x) / (b[1] + b[2] * x); }
Real lanczos(const Real* b, Real x, Real) {
  return b[0] * std::exp(-b[1] * x) + b[2] * std::exp(-b[3] * x) + b[4] * std::exp(-b[5] * x);
}
Real gauss(const Real* b, Real x, Real) {
  return b[0] * std::exp(-b[1] * x) + b[2] * std::exp(-square((x - b[3]) / b[4])) +
         b[5] * std::exp(-square((x - b[6]) / b[7]));
}
Real danwood(const Real* b, Real x, Real) { return b[0] * std::pow(x, b[1]); }
Real kirby2(const Real* b, Real x, Real) {
  return (b[0] + x * (b[1] + x * b[2])) / (1 + x * (b[3] + x * b[4]));
}
Real cubic_over_cubic(const Real* b, Real x, Real) {
  return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1 + x * (b[4] + x * (b[5] + x * b[6])));
}
Real nelson(const Real* b, Real x1, Real x2) { return b[0] - b[1] * x1 * std::exp(-b[2] * x2); }
Real mgh17(const Real* b, Real x, Real) {
  return b[0] + b[1] * std::exp(-x * b[3]) + b[2] * std::exp(-x * b[4]);
}
Real roszman1(const Real* b, Real x, Real) {
  return b[0] - b[1] * x - std::atan(b[2] / (x - b[3])) / pi;
}
Real enso(const Real* b, Real x, Real) {
  const auto wave = [x](Real cosine, Real sine, Real period) {
    return cosine * std::cos(2 * pi * x / period) + sine * std::sin(2 * pi * x / period);
  };
  return b[0] + wave(b[1], b[2], 12) + wave(b[4], b[5], b[3]) + wave(b[7], b[8], b[6]);
}
Real mgh09(const Real* b, Real x, Real) { return b[0] * x * (x + b[1]) / (x * (x + b[2]) + b[3]); }
Real mgh10(const Real* b, Real x, Real) { return b[0] * std::exp(b[1] / (x + b[2])); }
Real rat42(const Real* b, Real x, Real) { return b[0] / (1 + std::exp(b[1] - b[2] * x)); }
Real rat43(const Real* b, Real x, Real) {
  return b[0] / std::pow(1 + std::exp(b[1] - b[2] * x), 1 / b[3]);
}
Real eckerle4(const Real* b, Real x, Real) {
  return b[0] / b[1] * std::exp(-square((x - b[2]) / b[1]) / 2);
}
Real bennett5(const Real* b, Real x, Real) { return b[0] * std::pow(b[1] + x, -1 / b[2]); }

Model model_of(const std::string& name) {
  static const std::map<std::string, Model> models = {
      {"Misra1a", misra1a},   {"Misra1b", misra1b},
      {"Misra1c", misra1c},   {"Misra1d", misra1d},
      {"BoxBOD", misra1a},    {"Chwirut1", chwirut},
      {"Chwirut2", chwirut},  {"Lanczos1", lanczos},
      {"Lanczos2", lanczos},  {"Lanczos3", lanczos},
      {"Gauss1", gauss},      {"Gauss2", gauss},
      {"Gauss3", gauss},      {"DanWood", danwood},
      {"Kirby2", kirby2},     {"Hahn1", cubic_over_cubic},
      {"Nelson", nelson},     {"MGH17", mgh17},
      {"Roszman1", roszman1}, {"ENSO", enso},
      {"MGH09", mgh09},       {"Thurber", cubic_over_cubic},
      {"MGH10", mgh10},       {"Rat42", rat42},
      {"Rat43", rat43},       {"Eckerle4", eckerle4},
      {"Bennett5", bennett5}};
  return models.at(name);
}

/// Rows of cells below the header.
std::vector<std::vector<std::string>> table(const std::string& name) {
  std::ifstream file(std::string(TILTH_SOURCE_DIR) + "/tests/reference/nist_strd/" + name);
  if (!file) throw std::runtime_error("cannot read " + name);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

NistProblem& by_name(std::vector<NistProblem>& problems, const std::string& name) {
  return *std::ranges::find(problems, name, &NistProblem::name);
}

}  // namespace

std::vector<NistProblem> nist_problems() {
  std::vector<NistProblem> problems;
  for (const auto& row : table("problems.csv")) {
    NistProblem problem;
    problem.name = row[0];
    problem.degrees_of_freedom = std::stoi(row[3]);
    problem.residual_sum_of_squares = std::stod(row[4]);
    problems.push_back(problem);
  }
  for (const auto& row : table("parameters.csv")) {
    by_name(problems, row[0])
        .parameters.push_back(
            {row[1], {std::stod(row[2]), std::stod(row[3])}, std::stod(row[4]), std::stod(row[5])});
  }
  for (const auto& row : table("observations.csv")) {
    NistProblem& problem = by_name(problems, row[0]);
    const Real y = std::stold(row[1]);
    problem.y.push_back(problem.name == "Nelson" ? std::log(y) : y);
    problem.x1.push_back(std::stold(row[2]));
    problem.x2.push_back(row.size() > 3 ? std::stold(row[3]) : 0);
  }
  return problems;
}

const NistProblem& nist_problem(const std::vector<NistProblem>& problems, const std::string& name) {
  return *std::ranges::find(problems, name, &NistProblem::name);
}

std::vector<Parameter> nist_parameters(const NistProblem& problem, std::size_t start) {
  const bool is_positive = problem.name.starts_with("Lanczos");
  std::vector<Parameter> parameters;
  for (const NistParameter& b : problem.parameters) {
    const double larger = std::max(std::abs(b.starts[0]), std::abs(b.starts[1]));
    Parameter p;
    p.name = b.name;
    p.start = b.starts[start];
    p.upper = is_positive ? 2.0 * larger : 100.0 * larger;
    p.lower = is_positive ? 0.0 : -p.upper;
    parameters.push_back(p);
  }
  return parameters;
}

Simulator nist_simulator(const NistProblem& problem) {
  return [problem, model = model_of(problem.name)](const Eigen::MatrixXd& parameters,
                                                   std::span<const std::uint64_t>) {
    std::vector<Evaluation> runs;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      const std::vector<Real> b(parameters.col(i).begin(), parameters.col(i).end());
      Eigen::VectorXd difference(static_cast<Eigen::Index>(problem.y.size()));
      for (std::size_t k = 0; k < problem.y.size(); ++k) {
        difference[static_cast<Eigen::Index>(k)] =
            static_cast<double>(model(b.data(), problem.x1[k], problem.x2[k]) - problem.y[k]);
      }
      runs.push_back({EvaluationStatus::completed, difference, ""});
    }
    return runs;
  };
}

std::vector<Target> nist_targets(const NistProblem& problem) {
  std::vector<Target> targets(problem.y.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    targets[k].name = problem.name + "_" + std::to_string(k);
    targets[k].source = "NIST StRD";
  }
  return targets;
}

FitOptions nist_options() {
  FitOptions options = smooth_fit_options();
  options.rescale_sigma = true;
  options.profiles = ProfileSource::none;
  return options;
}

double correct_digits(double found, double certified) {
  if (!std::isfinite(found)) return 0.0;
  return std::clamp(-std::log10(std::abs(found / certified - 1.0)), 0.0, 11.0);
}

}  // namespace tilth::test
