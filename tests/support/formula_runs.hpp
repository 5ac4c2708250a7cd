// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The formula of formula_models.hpp as simulations of workers, store and broker.
#pragma once

#include <chrono>
#include <span>
#include <sstream>
#include <thread>
#include <vector>

#include "calibrate/run_broker.hpp"
#include "calibrate/simulator.hpp"
#include "tests/calibrate/formula_models.hpp"

namespace tilth::test {

inline constexpr double formula_noise = 0.05;

inline RunIdentity formula_run(const Eigen::VectorXd& parameters, std::uint64_t seed) {
  RunIdentity identity{"formula 1", "formula", "", seed, "packing_seed=" + std::to_string(seed) + "\n",
                       ""};
  char text[40];
  for (const double value : parameters) {
    std::snprintf(text, sizeof(text), "%a\n", value);
    identity.material += text;
  }
  return identity;
}

/// What a worker does: 4 ms of thought per run.
inline std::vector<RunRecord> simulate_formula(std::span<const RunIdentity> members) {
  std::vector<RunRecord> records;
  for (const RunIdentity& m : members) {
    std::vector<double> values;
    std::istringstream words(m.material);
    for (std::string word; words >> word;) values.push_back(std::strtod(word.c_str(), nullptr));
    const Eigen::Map<const Eigen::VectorXd> point(values.data(), static_cast<Eigen::Index>(values.size()));
    const std::uint64_t seeds[] = {m.seed};
    const Eigen::VectorXd features =
        simulator_of(soil_formula, formula_noise)(point, seeds).front().features;
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
    RunRecord r;
    r.state = RunState::completed;
    for (const double f : features) r.features.push_back({"f", f});
    records.push_back(r);
  }
  return records;
}

/// The same as a Simulator that asks a broker.
inline Simulator brokered_formula(RunBroker& broker) {
  return [&broker](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    std::vector<RunIdentity> wanted;
    for (std::size_t i = 0; i < seeds.size(); ++i)
      wanted.push_back(formula_run(parameters.col(static_cast<Eigen::Index>(i)), seeds[i]));
    std::vector<Evaluation> evaluations;
    for (const RunRecord& r : broker.run(wanted)) {
      Evaluation e;
      e.message = r.reason;
      if (r.state == RunState::completed) e.status = EvaluationStatus::completed;
      if (r.state == RunState::abandoned) e.status = EvaluationStatus::failed;
      e.features.resize(static_cast<Eigen::Index>(r.features.size()));
      for (std::size_t k = 0; k < r.features.size(); ++k)
        e.features[static_cast<Eigen::Index>(k)] = r.features[k].value;
      evaluations.push_back(e);
    }
    return evaluations;
  };
}

}  // namespace tilth::test
