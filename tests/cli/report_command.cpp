// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Which cards a report is made of, and its words. The page of a real fit: session.cpp.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "calibrate/cli/exit_code.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using namespace tilth::cli_test;
using soil_test::read_text;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// All a report reads, and no more.
Json small_card() {
  return Json::parse(R"({"schema": "tilth.card/1", "status": "converged", "soil": {}, "provenance": {}, "engine": {},
      "parameters": [{"name": "bond_modulus_Pa", "verdict": "bound_limited", "limited_by": "friction"}],
      "fit_statistics": {}, "warnings": [], "correlation": [], "validation": {"passed": null}, "failures": [],
      "responses": [{"name": "peak", "residual": 8, "reachability": "unreachable", "reach_gap": 7.5,
                     "conflicts_with": ""},
                    {"name": "strain", "residual": 3, "reachability": "unreachable", "reach_gap": -1.5,
                     "conflicts_with": "modulus", "joint_misfit": 3.2}],
      "cost": {"stages": []}, "inputs": [], "tool": {}, "scope": {}, "reproduction": {}})");
}

}  // namespace

TEST_CASE("Report: a card that lacks a section is refused by name, and nothing is written", "[cli][report]") {
  const TempFolder folder("report_cut");
  const Json whole = small_card();
  folder.write("fit.json", whole.dump());
  REQUIRE(run({"report", folder.path().string()}).exit_code == exit_done);
  for (const auto& [section, content] : whole.items()) {
    if (section == "status") continue;  // a text; an empty one may stand on the page
    INFO(section);
    fs::remove(folder / "report.html");
    Json cut = whole;
    cut.erase(section);
    folder.write("fit.json", cut.dump());
    const ProgramRun r = run({"report", folder.path().string()});
    CHECK(r.exit_code == exit_bad_input);
    CHECK(r.says({"fit.json", section == "schema" ? "no parameter card" : section}));
    CHECK_FALSE(fs::exists(folder / "report.html"));
  }
}

TEST_CASE("Report: a bound-limited parameter names the other one, and a conflict stands instead of the gap", "[cli][report]") {
  const TempFolder folder("report_words");
  folder.write("fit.json", small_card().dump());
  REQUIRE(run({"report", folder.path().string()}).exit_code == exit_done);
  const std::string page = read_text(folder / "report.html");
  CHECK_THAT(page, Contains("bound_limited (by friction)"));
  CHECK_THAT(page, Contains("(7.5 sigma)"));  // unreachable alone
  CHECK_THAT(page, Contains("not together with modulus (3.2 sigma)") && !Contains("(-1.5 sigma)"));
}
