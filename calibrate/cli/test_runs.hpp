// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Runs of virtual tests, from the store, by workers, or here.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "calibrate/cli/virtual_test.hpp"
#include "calibrate/run_broker.hpp"

namespace tilth {

/// What runs share: packings, threads, the stop flag; and, where results are to be kept, a broker.
struct RunContext {
  PackingStore& packings;
  int num_threads = 1;
  int max_lanes = 0;
  const std::atomic<bool>* stop = nullptr;
  RunBroker* broker = nullptr;  ///< null: everything runs in this process and nothing is kept
};

/// RunOptions whose packs run side by side on the context's threads; where fewer runs than threads are to be
/// made, every time step gets several.
RunOptions run_options(const RunContext& context, std::size_t num_runs);

/// One virtual test of one material; the packing seed is in the config.
struct TestRun {
  TestConfig config;
  std::string condition_id;
  SoilMaterial material;
};

/// Results in order. Runs of equal configs share packs.
std::vector<ExperimentResult> run_tests(std::span<const TestRun> runs, const RunContext& context);

RunIdentity identity_of(const TestRun& run);
/// The run an identity stands for. @throws std::runtime_error naming what cannot be read
TestRun run_of(const RunIdentity& identity);

RunRecord record_of(const ExperimentResult& result);
ExperimentResult result_of(const RunRecord& record);

/// Steps a run will take, up to a factor common to its test: with gravity or a tool in real time the number of time steps grows with the
/// square root of the modulus; a specimen that is sheared or compressed until it fails lasts as long as its failure strain, strength over
/// modulus.
double expected_effort(const RunIdentity& identity);

/// The worker's side: members of one setup on the lanes of this processor.
std::vector<RunRecord> simulate_members(std::span<const RunIdentity> members, PackingStore& packings,
                                        int max_lanes);

}  // namespace tilth
