// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A whole fit in small, to be killed: formula_program fit STORE OUT | formula_program worker
// Words for single faults of the worker, in the first material line: see worker_pool.cpp.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "calibrate/fit.hpp"
#include "calibrate/worker_loop.hpp"
#include "tests/support/formula_runs.hpp"

namespace {

using namespace tilth;
using namespace tilth::test;

/// Material "crash" or "hang" does so each time; "idle" is sent back as it came.
std::vector<RunRecord> simulate(std::span<const RunIdentity> members) {
  for (const RunIdentity& m : members) {
    if (m.material == "crash") std::abort();
    if (m.material == "hang") std::this_thread::sleep_for(std::chrono::hours(1));
    if (m.material == "throw") throw std::runtime_error("cannot be packed");
  }
  std::vector<RunRecord> records;
  for (const RunIdentity& m : members)
    records.push_back(m.material == "idle" ? RunRecord() : simulate_formula(std::span(&m, 1)).front());
  return records;
}

FitOptions options() {
  FitOptions o;
  o.num_design = 24;
  o.num_search_seeds = 2;
  o.num_fresh_seeds = 4;
  return o;
}

int run_fit_program(const std::string& own, const std::string& store_file, const std::string& out) {
  RunStore store(store_file);
  WorkerPool workers({own, "worker"}, 2);
  BrokerOptions broker_options;
  broker_options.run_timeout_s = 0.5;
  RunBroker broker(store, workers, broker_options);
  const FitSummary s = fit(soil_parameters(), soil_targets(0.05, 1), brokered_formula(broker), nullptr,
                           options());
  const std::string draft = out + ".part";
  std::FILE* file = std::fopen(draft.c_str(), "w");
  for (const double value : s.values()) std::fprintf(file, "%a\n", value);
  for (const double value : s.covariance.reshaped()) std::fprintf(file, "%a\n", value);
  std::fprintf(file, "chi-square %a, simulations %zu, failed %zu\n", s.chi_square, s.num_simulations,
               s.failures.size());
  std::fclose(file);
  std::filesystem::rename(draft, out);
  return s.is_usable() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "worker") return run_worker(simulate);
  if (command == "fit" && argc == 4) return run_fit_program(argv[0], argv[2], argv[3]);
  return 2;
}
