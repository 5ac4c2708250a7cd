// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/fit_all_soils.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/interrupt.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/cli/soil_comparison.hpp"
#include "calibrate/cli/walltime.hpp"
#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

namespace fs = std::filesystem;

constexpr int comparison_packings = 2;
constexpr std::uint64_t comparison_seeds = 6000;  ///< first one, over the fit's own

int worse(int a, int b) {
  constexpr int order[] = {exit_done,        exit_holdout_failed, exit_unreachable, exit_failed_runs,
                           exit_budget,      exit_bad_input,      exit_internal};
  const auto place = [&](int code) { return std::ranges::find(order, code) - std::begin(order); };
  return place(a) < place(b) ? b : a;
}

JobOptions job_of(const FitCommandOptions& o, const std::string& soil) {
  JobOptions job = o.job;
  job.soil = soil;
  return job;
}

/// Everything wrong with any of the fits, before one is started.
void check_all(const FitCommandOptions& o, const std::vector<std::string>& soils) {
  std::vector<std::string> found = problems(o.session);
  if (!o.job.soil_folder.empty()) found.emplace_back("--data is one folder, --soil says all");
  if (soils.empty()) found.emplace_back("--soil all: there is no soil under data/soils");
  for (const std::string& soil : soils) {
    try {
      refuse_bad_job(read_job(job_of(o, soil)), {});
    } catch (const ConfigError& e) {
      for (const std::string& sentence : e.sentences()) found.push_back(soil + ": " + sentence);
    }
  }
  if (!found.empty()) throw ConfigError(found);
}

class Clock {
 public:
  explicit Clock(const std::string& max_walltime)
      : limit_s_(seconds_of_walltime(max_walltime)), start_(std::chrono::steady_clock::now()) {}
  /// What is left, in the notation of --max-walltime; empty without a limit.
  std::string left() const {
    if (!limit_s_) return "";
    const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start_;
    const int left_s = std::max(1, static_cast<int>(*limit_s_ - gone.count()));
    return fmt::format("{}:{:02}", left_s / 60, left_s % 60);
  }

 private:
  std::optional<double> limit_s_;
  std::chrono::steady_clock::time_point start_;
};

FitCommandOptions one_fit(const FitCommandOptions& o, const std::string& soil, const fs::path& folder,
                          const Clock& clock) {
  FitCommandOptions one = o;
  one.job = job_of(o, soil);
  one.session.out = (folder / soil).string();
  one.session.resume = o.session.resume && fs::exists(folder / soil / "config.json");
  one.session.max_walltime = clock.left();
  return one;
}

/// A folder of earlier fits is gone on with, another is moved aside as every run folder is.
fs::path open_folder(const SessionOptions& o) {
  if (o.resume && fs::exists(o.out)) return o.out;
  return make_run_folder(o.out, "all_soils");
}

void compare(const FitCommandOptions& o, std::vector<FittedSoil> soils, const fs::path& folder, const Clock& clock,
             const std::string& command_line) {
  SessionOptions session_options = o.session;
  session_options.out = folder.string();
  session_options.max_walltime = clock.left();
  const RunSession session(session_options, folder);
  std::cerr << "drawing the sweep through all soils at their fitted values\n";
  run_sweeps(soils, o.job.quick ? Fidelity::preview : Fidelity::confirm, comparison_packings,
             o.job.seed + comparison_seeds, session.context());
  const std::string head = o.job.quick ? "PREVIEW (--quick): small, fast specimens; do not publish these numbers"
                                       : "Fitted soils beside each other";
  const std::string text = comparison_text(soils, head);
  write_file(folder / "comparison.txt", text);
  write_file(folder / "comparison.json", comparison_json(soils, job_command(o.job)));
  if (const std::string why = draw_comparison(soils, head, folder / "figures" / "comparison.svg"); !why.empty())
    std::cerr << "no figure: " << why << '\n';
  write_file(folder / "timing.json", session.timing_json(command_line));
  std::cout << text << fmt::format("comparison: {}\n", folder.string());
}

}  // namespace

int run_fit_of_all_soils(const FitCommandOptions& o, const std::string& command_line) {
  const std::vector<std::string> ids = soils_of_all();
  check_all(o, ids);
  const fs::path folder = open_folder(o.session);
  const Clock clock(o.session.max_walltime);
  int code = exit_done;
  std::vector<FittedSoil> soils;
  for (const std::string& id : ids) {
    const int own = run_fit(one_fit(o, id, folder, clock), command_line);
    code = worse(code, own);
    if (interrupt_flag().load() || own == exit_budget) return code;
    if (!fs::exists(folder / id / "fit.json") || own == exit_failed_runs) continue;
    FittedSoil fitted;
    fitted.soil = read_job(job_of(o, id)).soil;
    fitted.set = read_fit_card(folder / id);
    fitted.exit_code = own;
    soils.push_back(std::move(fitted));
  }
  if (!soils.empty()) compare(o, std::move(soils), folder, clock, command_line);
  return code;
}

}  // namespace tilth
