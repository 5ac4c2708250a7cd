// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Resume, budgets, stops, store and plan as a user meets them.
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calibrate/cli/config_difference.hpp"
#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/walltime.hpp"
#include "calibrate/run_store.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using Catch::Matchers::Contains;
using namespace tilth;
using namespace tilth::cli_test;
using soil_test::read_text;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> fit_into(const TempFolder& folder, const std::string& out) {
  return {"--data", folder / "soil", "--config", folder / "fit.json", "--quick", "--seed", "3",
          "--out",  folder / out};
}

/// A soil and a config for fit_into().
void prepare(const TempFolder& folder) {
  const std::string soil = one_test_soil(folder);
  if (soil != folder / "soil") fs::rename(soil, folder / "soil");
  folder.write("fit.json", tiny_config());
}

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("Session: a fit that is killed and resumed gives the card of one that was not, and repeats nothing",
          "[cli][session]") {
  const TempFolder folder("session_kill");
  prepare(folder);
  REQUIRE_NOTHROW(run_and_signal(fit_into(folder, "killed"), folder.path(), "noise floor", SIGKILL));
  const std::size_t before = RunStore(folder / "killed/evaluations.sqlite").keys().size();
  REQUIRE(before > 0);
  run_process(with(fit_into(folder, "killed"), {"--resume"}), folder.path());
  run_process(fit_into(folder, "whole"), folder.path());
  CHECK(read_text(folder / "killed/fit.json") == read_text(folder / "whole/fit.json"));
  CHECK(read_text(folder / "killed/fit_report.txt") == read_text(folder / "whole/fit_report.txt"));
  const RunStore store(folder / "killed/evaluations.sqlite");
  CHECK(store.keys().size() > before);
  CHECK(store.num_repeats() == 0);

  // another fit over the same store finds everything there
  const ProgramRun again =
      run_process(with(fit_into(folder, "again"), {"--store", folder / "whole/evaluations.sqlite"}), folder.path());
  CHECK(again.says({"0 tests simulated"}));
  CHECK(read_text(folder / "again/fit.json") == read_text(folder / "whole/fit.json"));
}

TEST_CASE("Session: a file STOP ends a fit with a valid card and exit code 3, and can be gone on from", "[cli][session]") {
  const TempFolder folder("session_stop");
  prepare(folder);
  const ProgramRun r = run_and_do(fit_into(folder, "run"), folder.path(), "noise floor",
                                  [&](pid_t) { folder.write("run/STOP", ""); });
  INFO(r.errors);
  CHECK(r.exit_code == exit_budget);
  CHECK(r.says({"a file STOP was found"}));
  const Json card = Json::parse(read_text(folder / "run/fit.json"));
  CHECK(card["schema"] == "tilth.card/1");
  CHECK(card["status"] == "stopped");
  CHECK(card["fit_statistics"]["chi_square"] <= card["fit_statistics"]["chi_square_start"]);
  CHECK_THAT(read_text(folder / "run/fit_report.txt"), Contains("[[Fit Statistics]]"));
  const ProgramRun resumed = run_process(with(fit_into(folder, "run"), {"--resume"}), folder.path());
  CHECK_FALSE(resumed.says({"STOP"}));
  CHECK(Json::parse(read_text(folder / "run/fit.json"))["status"] != "stopped");
}

TEST_CASE("Session: time limit and run limit end with a valid card and exit code 3", "[cli][session]") {
  const TempFolder folder("session_limits");
  prepare(folder);
  for (const std::vector<std::string>& limit :
       {std::vector<std::string>{"--max-walltime", "0:01"}, {"--max-runs", "12"}}) {
    const ProgramRun r = run_process(with(fit_into(folder, "limited"), limit), folder.path());
    INFO(r.errors);
    CHECK(r.exit_code == exit_budget);
    CHECK_THAT(read_text(folder / "limited/fit.json"), Contains("tilth.card/1"));
    CHECK_THAT(read_text(folder / "limited/fit_report.txt"), Contains("[[Fit Statistics]]"));
  }
}

TEST_CASE("Session: a folder another program works in is refused and stays where it is", "[cli][session]") {
  const TempFolder folder("session_in_use");
  prepare(folder);
  fs::create_directory(folder.path() / "busy");
  folder.write("busy/result.txt", "half done");
  const FolderLock other_program(folder.path() / "busy");
  const ProgramRun r = run_process(fit_into(folder, "busy"), folder.path());
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"another calibrate is working in this folder"}));
  CHECK(read_text(folder / "busy/result.txt") == "half done");
}

TEST_CASE("Session: what cannot be resumed is refused with every difference", "[cli][session]") {
  const TempFolder folder("session_differs");
  prepare(folder);
  run_process(with(fit_into(folder, "one"), {"--max-runs", "12"}), folder.path());
  std::vector<std::string> other = with(fit_into(folder, "one"), {"--resume"});
  other[6] = "4";  // the seed
  const std::string card = read_text(folder / "one/fit.json");
  const ProgramRun r = run_process(other, folder.path());
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"made for another run", "/fit/seed: 3 there, 4 here"}));
  CHECK(read_text(folder / "one/fit.json") == card);
  CHECK(config_differences(R"({"fit":{"seed":1,"max_simulations":5},"tool":1})",
                           R"({"fit":{"seed":1,"max_simulations":9},"tool":2})")
            .empty());
}

TEST_CASE("Session: bad limits, stores and folders are all named at once", "[cli][session]") {
  const TempFolder folder("session_bad");
  prepare(folder);
  const ProgramRun r = run({"--data", folder / "soil", "--config", folder / "fit.json", "--resume",
                            "--max-walltime", "soon", "--store", folder.path().string()});
  CHECK(r.exit_code == exit_bad_input);
  CHECK(r.says({"--max-walltime soon", "--resume needs --out", "is a folder; name a file"}));
  folder.write("text.sqlite", "not a database, but long enough to look at as one, is it not?");
  const ProgramRun store =
      run(with(fit_into(folder, "out"), {"--store", folder / "text.sqlite"}));
  CHECK(store.exit_code == exit_bad_input);
  CHECK(store.says({"text.sqlite", "cannot be used as evaluation store"}));
}

TEST_CASE("Session: a file that may not grow ends with exit code 1 and a whole store", "[cli][session]") {
  const TempFolder folder("session_full");
  prepare(folder);
  std::string command = "ulimit -f 64; exec " TILTH_PROGRAM;  // blocks of 512 or 1024 bytes
  for (const std::string& a : fit_into(folder, "full")) command += " '" + a + "'";
  const int status = std::system(("bash -c \"" + command + "\" 2> " + (folder / "words.txt")).c_str());
  CHECK(WEXITSTATUS(status) == exit_internal);
  CHECK_THAT(read_text(folder / "words.txt"), Contains("evaluations.sqlite") && Contains("safe"));
  const std::size_t kept = RunStore(folder / "full/evaluations.sqlite").keys().size();
  CHECK(kept > 0);
  const ProgramRun resumed = run_process(with(fit_into(folder, "full"), {"--resume"}), folder.path());
  CHECK(resumed.exit_code != exit_internal);
}

TEST_CASE("Session: a file that cannot be written names the system's reason and what to do", "[cli][session]") {
  const TempFolder folder("session_write");
  fs::create_directories(folder.path() / "card.json.part");  // the draft's place is taken
  CHECK_THROWS_WITH(write_file(folder.path() / "card.json", "{}"),
                    Contains("card.json") && Contains("Is a directory") && Contains("--resume"));
  CHECK_FALSE(fs::exists(folder.path() / "card.json"));
}

TEST_CASE("Session: Slurm's ways to write a time", "[cli][session]") {
  CHECK(seconds_of_walltime("30") == 1800.0);
  CHECK(seconds_of_walltime("30:15") == 1815.0);
  CHECK(seconds_of_walltime("1:30:00") == 5400.0);
  CHECK(seconds_of_walltime("2-12") == 216000.0);
  CHECK(seconds_of_walltime("2-12:30") == 217800.0);
  CHECK(seconds_of_walltime("2-12:30:05") == 217805.0);
  for (const char* wrong : {"", "soon", "1:2:3:4", "-5", "0", "1:", "2-", "1.5", "3-4-5"})
    CHECK_FALSE(seconds_of_walltime(wrong));
}

TEST_CASE("Plan: counts runs and core-hours, and starts nothing", "[cli][session]") {
  const TempFolder folder("session_plan");
  const ProgramRun r = run({"plan", "--soil", "loamy_sand"});
  CHECK(r.exit_code == exit_done);
  CHECK_THAT(r.output, Contains("local search") && Contains("core-hours") &&
                           Contains("3 free parameters, 34 independent observations") && !Contains("nan"));
  CHECK(r.says({"30 of 34 targets of the fit are synthetic"}));
  const ProgramRun mechanical = run({"plan", "--soil", "loamy_sand", "--tests", "mechanical"});
  CHECK_THAT(mechanical.output, Contains("3 free parameters, 4 independent observations"));
  CHECK_FALSE(mechanical.says({"synthetic"}));
  CHECK(run({"plan", "--soil", "loamy_sand", "--quick"}).says({"leaves out the 45 targets of the sweep"}));
  CHECK(run({"plan", "--soil", "moon_dust"}).exit_code == exit_bad_input);
}

TEST_CASE("Cache: lists, shows, merges and removes runs", "[cli][session]") {
  const TempFolder folder("session_cache");
  prepare(folder);
  run_process(with(fit_into(folder, "one"), {"--max-runs", "12"}), folder.path());
  CHECK_THAT(run({"cache", "ls", folder / "one"}).output, Contains("unconfined_compression"));
  const std::vector<std::string> keys = RunStore(folder / "one/evaluations.sqlite").keys();
  const ProgramRun shown = run({"cache", "show", folder / "one", "--key", keys.front()});
  CHECK_THAT(shown.output, Contains("COMPLETED") && Contains("friction=") && Contains("peak_stress_Pa"));
  RunStore(folder / "all.sqlite");
  run({"cache", "merge", folder / "all.sqlite", folder / "one"});
  CHECK(RunStore(folder / "all.sqlite").keys() == keys);
  CHECK(run({"cache", "remove", folder / "all.sqlite"}).exit_code == exit_bad_input);
  run({"cache", "remove", folder / "all.sqlite", "--key", keys.front().substr(0, 10)});
  CHECK(RunStore(folder / "all.sqlite").keys().size() == keys.size() - 1);
}

TEST_CASE("Report: one page, offline, first line the share of measured targets, every section and figure",
          "[cli][report]") {
  const TempFolder folder("report_page");
  prepare(folder);
  const ProgramRun fit = run_process(fit_into(folder, "run"), folder.path());
  INFO(fit.errors);
  const std::string page = read_text(folder / "run/report.html");
  const std::size_t share = page.find("measured targets: 0 of 2 (0 %)");
  REQUIRE(share != std::string::npos);
  CHECK(share < page.find("<h1>"));
  for (const char* part : {"PREVIEW", "bond_modulus_Pa", "Correlations", "id=\"holdout\"", "id=\"failures\"",
                           "id=\"cost\"", "id=\"again\"", "SHA-256", "strain_at_peak"})
    CHECK_THAT(page, Contains(part));
  std::size_t num_figures = 0, num_images = 0;
  for (const auto& entry : fs::directory_iterator(folder / "run/figures"))
    num_figures += entry.path().extension() == ".svg" ? 1 : 0;
  for (std::size_t at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1)) ++num_images;
  CHECK(num_images == num_figures);
  CHECK_THAT(page, !Contains("src=\"http") && !Contains("href=\"http"));
  // it can be made again from the machine files alone
  fs::remove(folder / "run/report.html");
  CHECK(run({"report", folder / "run"}).exit_code == exit_done);
  CHECK(read_text(folder / "run/report.html") == page);
  CHECK(run({"report", folder / "soil"}).exit_code == exit_bad_input);
  CHECK(run({"report", folder / "nowhere"}).exit_code == exit_bad_input);
}

TEST_CASE("Validate: predicts new data by the pass mark of the fit, and refuses what does not fit together",
          "[cli][validate]") {
  const TempFolder folder("validate");
  prepare(folder);
  const ProgramRun fit = run_process(fit_into(folder, "run"), folder.path());
  INFO(fit.errors);
  const ProgramRun same = run_process({"validate", folder / "run", "--data", folder / "soil", "--seeds", "2",
                                       "--out", folder / "same"}, folder.path());
  INFO(same.errors);
  CHECK(same.exit_code == exit_done);
  CHECK_THAT(same.output, Contains("passed") && Contains("peak_stress_Pa") && Contains("strain_at_peak"));
  CHECK_THAT(read_text(folder / "same/validation.json"), Contains("\"passed\": true"));

  // a soil ten times as strong is another soil
  std::string table = read_text(folder / "soil/measurements.csv");
  table.replace(table.find("14160"), 5, "941600");
  soil_test::write_text(fs::path(folder / "soil/measurements.csv"), table);
  CHECK(run_process({"validate", folder / "run", "--data", folder / "soil", "--seeds", "2", "--out", folder / "other"},
                    folder.path()).exit_code == exit_holdout_failed);
  CHECK(run({"validate", folder / "soil", "--data", folder / "soil"}).exit_code == exit_bad_input);
  CHECK(run({"validate", folder / "run", "--data", folder / "nothing"}).exit_code == exit_bad_input);
}
