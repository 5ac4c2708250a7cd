// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate cache` on stores that are absent, long or filled from elsewhere. On that of a fit: session.cpp.
#include <catch2/catch.hpp>
#include <filesystem>
#include <span>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/run_message.hpp"
#include "calibrate/run_store.hpp"
#include "tests/cli/program_run.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using namespace tilth::cli_test;
namespace fs = std::filesystem;

TEST_CASE("Cache: a store that is not there is refused and not made, except by a merge with a source", "[cli][session]") {
  const TempFolder folder("session_cache_absent");
  const std::string none = folder / "none.sqlite";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"cache", "ls", none}, {"cache", "show", none},
        {"cache", "remove", none, "--all"}, {"cache", "merge", none}}) {
    INFO(arguments[1]);
    const ProgramRun r = run(arguments);
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says({arguments[1] == "merge" ? "name what shall be taken over" : "there is no such evaluation store"}));
    CHECK_FALSE(fs::exists(none));
  }
  folder.write("empty.sqlite", "");
  CHECK(run({"cache", "ls", folder / "empty.sqlite"}).exit_code == exit_bad_input);
  RunStore(folder / "one.sqlite");
  CHECK(run({"cache", "merge", none, folder / "one.sqlite"}).exit_code == exit_done);
  CHECK(fs::exists(none));
}

TEST_CASE("Cache: a list that is cut says so, and a worker's answer replaces a FAILED run and no other", "[cli][session]") {
  const TempFolder folder("session_cache_list");
  std::vector<RunRecord> records;
  for (int k = 0; k < 25; ++k) {
    RunRecord r;
    r.identity = {"solver", "direct_shear", "lab", 1, "", "friction=" + std::to_string(k)};
    r.key = run_key(r.identity);
    r.state = k == 0 ? RunState::failed : RunState::completed;
    r.reason = "as it was";
    records.push_back(r);
  }
  RunStore store(folder / "s.sqlite");
  store.add(records);
  CHECK_THAT(run({"cache", "show", folder / "s.sqlite"}).output, Contains("20 of 25 runs shown"));

  for (RunRecord& r : records) r.state = RunState::completed, r.reason = "from elsewhere";
  folder.write("answer.json", answer_message(std::span(records).first(2)));
  const ProgramRun merged = run({"cache", "merge", folder / "s.sqlite", folder / "answer.json"});
  CHECK_THAT(merged.output, Contains("1 runs taken"));
  CHECK(store.find(records[0].key)->reason == "from elsewhere");
  CHECK(store.find(records[1].key)->reason == "as it was");
  CHECK(store.num_repeats() == 0);
}
