// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_broker.hpp"

#include <catch2/catch.hpp>

#include "tests/cli/program_run.hpp"
#include "tests/support/formula_runs.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using namespace tilth::test;
using cli_test::TempFolder;

namespace {

struct Laboratory {
  TempFolder folder;
  RunStore store;
  WorkerPool workers{{TILTH_FORMULA_PROGRAM, "worker"}, 2};
  RunBroker broker;

  explicit Laboratory(const std::string& name, BrokerOptions options = {})
      : folder(name), store(folder / "s.sqlite"), broker(store, workers, std::move(options)) {}
};

RunIdentity doing(const std::string& deed) {
  RunIdentity identity = formula_run(soil_truth(), 1);
  identity.material = deed;
  return identity;
}

RunIdentity point(double friction) {
  Eigen::VectorXd p = soil_truth();
  p[2] = friction;
  return formula_run(p, 1);
}

}  // namespace

TEST_CASE("Run broker: results are those of the simulator, in order, each simulated once",
          "[calibrate][broker]") {
  Laboratory lab("broker_order");
  std::vector<RunIdentity> wanted;
  for (int k = 0; k < 20; ++k) wanted.push_back(point(0.3 + 0.01 * (k % 10)));
  const std::vector<RunRecord> records = lab.broker.run(wanted);
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    REQUIRE(records[k].state == RunState::completed);
    const double expected = simulate_formula(std::span(&wanted[k], 1)).front().features[0].value;
    CHECK(records[k].features[0].value == expected);
  }
  CHECK(lab.broker.counts().num_simulated == 10);
  lab.broker.run(wanted);
  CHECK(lab.broker.counts().num_simulated == 10);
  CHECK(lab.broker.counts().num_from_store == 10);
  CHECK(lab.store.num_repeats() == 0);
}

TEST_CASE("Run broker: one that crashes is abandoned after three tries with its words, its neighbours live",
          "[calibrate][broker]") {
  Laboratory lab("broker_crash");
  std::vector<RunIdentity> wanted = {point(0.3), doing("crash"), point(0.4), point(0.5)};
  const std::vector<RunRecord> records = lab.broker.run(wanted);
  CHECK(records[0].state == RunState::completed);
  CHECK(records[2].state == RunState::completed);
  CHECK(records[3].state == RunState::completed);
  CHECK(records[1].state == RunState::abandoned);
  CHECK(records[1].num_tries == 3);
  CHECK_THAT(records[1].reason, Contains("signal 6") && Contains("3 tries"));
  // never to be tried again
  const std::size_t retries = lab.broker.counts().num_retries;
  CHECK(lab.broker.run(wanted)[1].state == RunState::abandoned);
  CHECK(lab.broker.counts().num_retries == retries);
}

TEST_CASE("Run broker: one that hangs is killed and abandoned, one that is refused is not tried again",
          "[calibrate][broker]") {
  BrokerOptions options;
  options.run_timeout_s = 0.3;
  Laboratory lab("broker_hang", options);
  const std::vector<RunRecord> records =
      lab.broker.run(std::vector{doing("hang"), doing("throw"), point(0.3)});
  CHECK(records[0].state == RunState::abandoned);
  CHECK_THAT(records[0].reason, Contains("not finished after 0.3 s"));
  CHECK(records[1].state == RunState::abandoned);
  CHECK(records[1].reason == "cannot be packed");
  CHECK(records[1].num_tries == 1);
  CHECK(records[2].state == RunState::completed);
}

TEST_CASE("Run broker: one that always comes back unrun is abandoned after three tries", "[calibrate][broker]") {
  Laboratory lab("broker_idle");
  const std::vector<RunRecord> records = lab.broker.run(std::vector{point(0.3), doing("idle")});
  CHECK(records[0].state == RunState::completed);
  CHECK(records[1].state == RunState::abandoned);
  CHECK_THAT(records[1].reason, Contains("without having run it") && Contains("3 tries"));
  CHECK(lab.store.find(records[1].key)->state == RunState::abandoned);
}

TEST_CASE("Run broker: a stop leaves what is finished in the store and the rest as candidates",
          "[calibrate][broker]") {
  std::size_t num_ended = 0;
  for (const StopWish wish : {StopWish::at_once, StopWish::finish_running}) {
    bool stop = false;
    BrokerOptions options;
    options.max_members = 1;
    options.stop = [&] { return stop ? wish : StopWish::none; };
    options.progress = [&](std::size_t done, std::size_t) { stop = done >= 3; };
    Laboratory lab("broker_stop", options);
    std::vector<RunIdentity> wanted;
    for (int k = 0; k < 30; ++k) wanted.push_back(point(0.3 + 0.01 * k));
    num_ended = 0;
    for (const RunRecord& r : lab.broker.run(wanted)) {
      if (r.state == RunState::completed) ++num_ended;
      else CHECK(r.state == RunState::candidate);
    }
    CHECK(num_ended >= 3);
    CHECK(num_ended < 8);
    CHECK(lab.store.keys().size() == num_ended);
  }
}

TEST_CASE("Run broker: a worker that cannot start is an error with its words, not a failed run",
          "[calibrate][broker]") {
  const TempFolder folder("broker_start");
  RunStore store(folder / "s.sqlite");
  WorkerPool workers({"/bin/sh", "-c", "echo no such library >&2; exit 3"}, 2);
  RunBroker broker(store, workers, {});
  REQUIRE_THROWS_WITH(broker.run(std::vector{point(0.3)}),
                      Contains("exit code 3") && Contains("no such library"));
  CHECK(store.keys().empty());
}

TEST_CASE("Members per job: every worker has a job, no job is wider than a pack", "[calibrate][broker]") {
  CHECK(members_per_job(33, 2, 8) == 8);
  CHECK(members_per_job(5, 2, 8) == 3);
  CHECK(members_per_job(1, 2, 8) == 1);
  CHECK(members_per_job(7, 1, 8) == 7);
}

TEST_CASE("Jobs: runs of like effort ride together, the longest first, every run once", "[calibrate][broker]") {
  const std::vector<double> effort = {1.0, 9.0, 2.0, 8.0, 1.0};
  const auto jobs = jobs_of_like_effort({0, 1, 2, 3, 4}, [&](std::size_t k) { return effort[k]; }, 2);
  CHECK(jobs == std::vector<std::vector<std::size_t>>{{1, 3}, {2, 0}, {4}});
  // without efforts the order stays
  CHECK(jobs_of_like_effort({4, 2, 0}, nullptr, 2) == std::vector<std::vector<std::size_t>>{{4, 2}, {0}});
}

TEST_CASE("Run broker: efforts change no result and no order", "[calibrate][broker]") {
  BrokerOptions options;
  options.effort = [](const RunIdentity& i) { return static_cast<double>(std::hash<std::string>{}(i.material)); };
  Laboratory lab("broker_effort", options);
  std::vector<RunIdentity> wanted;
  for (int k = 0; k < 12; ++k) wanted.push_back(point(0.3 + 0.01 * k));
  const std::vector<RunRecord> records = lab.broker.run(wanted);
  for (std::size_t k = 0; k < wanted.size(); ++k)
    CHECK(records[k].features[0].value == simulate_formula(std::span(&wanted[k], 1)).front().features[0].value);
}
