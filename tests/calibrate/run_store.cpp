// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>

#include "calibrate/config_error.hpp"
#include "calibrate/run_message.hpp"
#include "tests/cli/program_run.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using cli_test::TempFolder;

namespace {

RunRecord record(double friction, RunState state = RunState::completed) {
  RunRecord r;
  r.identity = {"solver 1", "direct_shear", "lab", 7, "packing_seed=7\n", "friction=" + std::to_string(friction)};
  r.key = run_key(r.identity);
  r.state = state;
  r.reason = state == RunState::completed ? "" : "the worker died";
  r.num_tries = 1;
  r.dt_s = 1.0 / 3.0;
  r.num_steps = 4'000'000'000;
  r.wall_s = 2.5;
  if (state == RunState::completed) r.features = {{"peak_stress_Pa", 0.1 + friction}, {"none", NAN}};
  r.curves = {{"shear_20kPa", {"x_m", "stress_Pa"}, {{0.0, 1e-300}, {1.0 / 7.0, -0.0}}}};
  return r;
}

std::string bits(const RunRecord& r) { return answer_message(std::span(&r, 1)); }

}  // namespace

TEST_CASE("Run store: a record comes back with every bit, NaN included", "[calibrate][store]") {
  const TempFolder folder("store_bits");
  const RunRecord put = record(0.3);
  RunStore(folder / "s.sqlite").add(std::vector{put});
  const auto got = RunStore(folder / "s.sqlite", RunStore::Mode::read_only).find(put.key);
  REQUIRE(got);
  CHECK(bits(*got) == bits(put));
  CHECK(std::isnan(got->features[1].value));
  CHECK(std::signbit(got->curves[0].rows[1][1]));
  CHECK(bits(read_answer(bits(put)).front()) == bits(put));
}

TEST_CASE("Run store: the key is the content: solver, test, setup and material, not the condition's name",
          "[calibrate][store]") {
  const RunIdentity a = record(0.3).identity;
  RunIdentity b = a;
  b.condition = "renamed";
  CHECK(run_key(a) == run_key(b));
  for (std::string RunIdentity::* part :
       {&RunIdentity::solver, &RunIdentity::test, &RunIdentity::setup, &RunIdentity::material}) {
    RunIdentity c = a;
    c.*part += "x";
    CHECK(run_key(c) != run_key(a));
  }
  RunIdentity shifted = a;  // the border between two parts counts
  shifted.setup += shifted.material.front();
  shifted.material.erase(0, 1);
  CHECK(run_key(shifted) != run_key(a));
}

TEST_CASE("Run store: what is final stays, what failed is replaced, repeats are counted",
          "[calibrate][store]") {
  const TempFolder folder("store_final");
  RunStore store(folder / "s.sqlite");
  store.add(std::vector{record(0.3, RunState::failed)});
  store.add(std::vector{record(0.3)});
  CHECK(store.find(record(0.3).key)->state == RunState::completed);
  CHECK(store.num_repeats() == 0);
  store.add(std::vector{record(0.3, RunState::abandoned)});
  CHECK(store.find(record(0.3).key)->state == RunState::completed);
  CHECK(store.num_repeats() == 1);
  CHECK(store.counts().front().num_completed == 1);
}

TEST_CASE("Run store: a batch that cannot be written leaves nothing of itself", "[calibrate][store]") {
  const TempFolder folder("store_atomic");
  RunStore store(folder / "s.sqlite");
  store.add(std::vector{record(0.1)});
  {  // fails at the second record of the next batch
    SQLite::Database raw(folder / "s.sqlite", SQLite::OPEN_READWRITE);
    raw.exec("CREATE TRIGGER refuse BEFORE INSERT ON runs WHEN NEW.key = '" + record(0.3).key +
             "' BEGIN SELECT RAISE(ABORT, 'disk is full'); END");
  }
  REQUIRE_THROWS_WITH(store.add(std::vector{record(0.2), record(0.3)}),
                      Contains("disk is full") && Contains("safe"));
  CHECK(store.keys().size() == 1);
  CHECK(store.find(record(0.1).key));
}

TEST_CASE("Run store: two programs fill one file, merge takes what is missing, remove selects",
          "[calibrate][store]") {
  const TempFolder folder("store_two");
  RunStore one(folder / "s.sqlite"), two(folder / "s.sqlite"), other(folder / "o.sqlite");
  one.add(std::vector{record(0.1)});
  two.add(std::vector{record(0.2)});
  CHECK(one.keys().size() == 2);
  other.add(std::vector{record(0.2), record(0.5), record(0.6, RunState::abandoned)});
  CHECK(one.merge(other) == 2);
  CHECK(one.keys().size() == 4);
  CHECK(one.remove({.solver_not = "solver 1"}) == 0);
  CHECK(one.remove({.only_failed = true}) == 1);
  CHECK(one.remove({.key_prefix = record(0.5).key.substr(0, 12)}) == 1);
  CHECK(one.remove({.solver_not = "solver 2"}) == 2);
  // features and curves go with their run
  SQLite::Database raw(folder / "s.sqlite");
  CHECK(raw.execAndGet("SELECT count(*) FROM features").getInt() == 0);
  CHECK(raw.execAndGet("SELECT count(*) FROM curves").getInt() == 0);
}

TEST_CASE("Run store: what is no store is refused by name", "[calibrate][store]") {
  const TempFolder folder("store_bad");
  CHECK_THROWS_AS(RunStore(folder / "none.sqlite", RunStore::Mode::read_only), ConfigError);
  CHECK_THROWS_AS(RunStore(folder / "no" + std::string("/folder/s.sqlite")), ConfigError);
  std::ofstream(folder / "text.sqlite") << "friction;0.3 and so on, long enough to be no database";
  CHECK_THROWS_AS(RunStore(folder / "text.sqlite"), ConfigError);
  SQLite::Database(folder / "foreign.sqlite", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE birds (name TEXT)");
  CHECK_THROWS_AS(RunStore(folder / "foreign.sqlite"), ConfigError);
}
