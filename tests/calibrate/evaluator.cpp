// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/evaluator.hpp"

#include <catch2/catch.hpp>

#include "tests/calibrate/formula_models.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using namespace tilth::test;

namespace {

std::vector<Target> one_target() { return {log_target("y_Pa", 1.0, 0.1)}; }

Simulator counting(int& num_columns) {
  return [&num_columns](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t>) {
    std::vector<Evaluation> runs;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      ++num_columns;
      runs.push_back({EvaluationStatus::completed, parameters.col(i).head(1), ""});
    }
    return runs;
  };
}

SimulationLedger ledger_with(std::size_t budget) {
  SimulationLedger ledger;
  ledger.max_simulations = budget;
  begin_stage(ledger, "test");
  return ledger;
}

}  // namespace

TEST_CASE("Evaluator: nothing is simulated twice, within a batch or later",
          "[calibrate][evaluator]") {
  int num_columns = 0;
  SimulationLedger ledger = ledger_with(100);
  Evaluator evaluator(counting(num_columns), one_target(), "search", ledger);
  const Eigen::MatrixXd batch = Eigen::RowVector3d(1.0, 2.0, 1.0);
  const auto first = evaluator.evaluate(batch, 1);
  REQUIRE(num_columns == 2);
  REQUIRE(first[2].features[0] == 1.0);
  evaluator.evaluate(batch, 1);
  REQUIRE(num_columns == 2);
  evaluator.evaluate(batch, 2);  // another packing is another simulation
  REQUIRE(num_columns == 4);
  REQUIRE(ledger.num_done == 4);
  REQUIRE(ledger.stages.front().num_completed == 4);
}

TEST_CASE("Evaluator: a result that cannot be used is a recorded failure, never a number",
          "[calibrate][evaluator]") {
  SimulationLedger ledger = ledger_with(100);
  const auto infinite_at_zero = [](const Eigen::VectorXd& p) -> Eigen::VectorXd {
    return p.cwiseInverse();
  };
  Evaluator evaluator(simulator_of(infinite_at_zero), one_target(), "search", ledger);
  const auto runs = evaluator.evaluate(Eigen::RowVector3d(0.0, -1.0, 2.0), 5);
  REQUIRE(runs[0].status == EvaluationStatus::failed);
  REQUIRE_THAT(runs[0].message, Contains("y_Pa") && Contains("not finite"));
  REQUIRE(runs[1].status == EvaluationStatus::failed);
  REQUIRE_THAT(runs[1].message, Contains("y_Pa = -1") && Contains("positive"));
  REQUIRE(runs[2].status == EvaluationStatus::completed);
  REQUIRE(ledger.failures.size() == 2);
  REQUIRE(ledger.failures[1].parameters[0] == -1.0);
  REQUIRE(ledger.failures[1].seed == 5);
}

TEST_CASE("Evaluator: a wrong number of features fails, of results throws",
          "[calibrate][evaluator]") {
  SimulationLedger ledger = ledger_with(100);
  Evaluator wide(simulator_of([](const Eigen::VectorXd&) { return Eigen::VectorXd::Ones(3); }),
                 one_target(), "search", ledger);
  REQUIRE(wide.evaluate(Eigen::MatrixXd::Ones(1, 1), 1).front().status == EvaluationStatus::failed);
  Evaluator silent([](const Eigen::MatrixXd&,
                      std::span<const std::uint64_t>) { return std::vector<Evaluation>{}; },
                   one_target(), "search", ledger);
  REQUIRE_THROWS_AS(silent.evaluate(Eigen::MatrixXd::Ones(1, 1), 1), std::runtime_error);
}

TEST_CASE("Evaluator: the budget is spent to the last simulation and not beyond",
          "[calibrate][evaluator]") {
  int num_columns = 0;
  SimulationLedger ledger = ledger_with(5);
  ledger.num_reserved = 2;
  Evaluator evaluator(counting(num_columns), one_target(), "search", ledger);
  const auto runs = evaluator.evaluate(Eigen::RowVectorXd::LinSpaced(4, 1.0, 4.0), 1);
  REQUIRE(num_columns == 3);
  REQUIRE(runs[3].status == EvaluationStatus::skipped);
  REQUIRE(ledger.budget_spent);
  ledger.num_reserved = 0;
  evaluator.evaluate(Eigen::RowVectorXd::LinSpaced(9, 10.0, 18.0), 1);
  REQUIRE(num_columns == 5);
}

TEST_CASE("Evaluator: after a stop remembered results are given and nothing new is run",
          "[calibrate][evaluator]") {
  int num_columns = 0;
  bool stop = false;
  SimulationLedger ledger = ledger_with(100);
  ledger.should_stop = [&] { return stop; };
  Evaluator evaluator(counting(num_columns), one_target(), "search", ledger);
  evaluator.evaluate(Eigen::MatrixXd::Ones(1, 1), 1);
  stop = true;
  const auto runs = evaluator.evaluate(Eigen::RowVector2d(1.0, 2.0), 1);
  REQUIRE(runs[0].status == EvaluationStatus::completed);
  REQUIRE(runs[1].status == EvaluationStatus::skipped);
  REQUIRE(num_columns == 1);
  REQUIRE(ledger.stop_seen);
}

TEST_CASE("Evaluator: a stop in the middle of a batch is known although nobody asks again",
          "[calibrate][evaluator]") {
  bool stop = false;
  SimulationLedger ledger = ledger_with(100);
  ledger.should_stop = [&stop] { return stop; };
  const Simulator stopped = [&stop](const Eigen::MatrixXd& parameters, std::span<const std::uint64_t>) {
    stop = true;  // while it runs
    return std::vector<Evaluation>(static_cast<std::size_t>(parameters.cols()));
  };
  Evaluator evaluator(stopped, one_target(), "search", ledger);
  REQUIRE(evaluator.evaluate(Eigen::MatrixXd::Constant(1, 1, 1.0), 1)[0].status == EvaluationStatus::skipped);
  CHECK(ledger.stop_seen);
  CHECK(ledger.num_done == 0);
}

TEST_CASE("Evaluator: more than 30 % failures in a batch of 8 raise the flag, 25 % do not",
          "[calibrate][evaluator]") {
  for (const auto& [num_bad, expected] : {std::pair{2, false}, std::pair{3, true}}) {
    SimulationLedger ledger = ledger_with(100);
    const int bad = num_bad;
    Evaluator evaluator(failing(simulator_of([](const Eigen::VectorXd& p) { return p; }),
                                [bad](const Eigen::VectorXd& p) { return p[0] <= bad; }),
                        one_target(), "search", ledger);
    evaluator.evaluate(Eigen::RowVectorXd::LinSpaced(8, 1.0, 8.0), 1);
    REQUIRE(ledger.too_many_failures == expected);
  }
}
