// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The junction: a soil's tables become a fit problem whose simulator runs virtual tests.
#pragma once

#include "calibrate/cli/test_runs.hpp"
#include "calibrate/evaluator.hpp"
#include "calibrate/simulator.hpp"

namespace tilth {

/// One virtual test under one condition, and the targets it answers.
struct PlannedTest {
  TestConfig config;
  std::string condition_id;
  struct Answer {
    std::size_t target = 0;  ///< index into SoilData::targets
    std::string feature;
  };
  std::vector<Answer> answers;
};

/// The tests that answer the targets of a soil in scope, each test and condition once.
std::vector<PlannedTest> plan_tests(const SoilData& soil, Fidelity fidelity,
                                    TargetScope scope = TargetScope::all);

/// Material of one parameter column (SoilData::parameters order), ties applied.
/// @throws ConfigError if a parameter of the table is not one of the model
SoilMaterial material_of(const SoilData& soil, const Eigen::VectorXd& values);

/// What a failed test does to the other tests of its member.
enum class FailedTest {
  fails_member,   ///< the member has failed, for the first failing test's reason
  leaves_others,  ///< its features are NaN, the reasons are the message: a partial simulator
};

/// Simulator over the planned tests: features in target order, members of one seed in the same packs. A member
/// in which no test completed has failed; targets out of scope are NaN. Soil and context must
/// outlive it.
Simulator dem_simulator(const SoilData& soil, Fidelity fidelity, const RunContext& context,
                        TargetScope scope = TargetScope::all,
                        FailedTest failed_test = FailedTest::fails_member);

}  // namespace tilth
