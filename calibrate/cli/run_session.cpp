// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/run_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <fstream>
#include <iterator>

#include "calibrate/cli/command_worker.hpp"
#include "calibrate/cli/config_difference.hpp"
#include "calibrate/cli/interrupt.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/cli/walltime.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/parallel.hpp"

namespace tilth {
namespace fs = std::filesystem;
namespace {

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

void add_session_options(CLI::App& app, SessionOptions& o) {
  app.add_option("--out", o.out, "run folder (default runs/<name>-<n>)");
  app.add_flag("--resume", o.resume, "go on in the run folder of --out: nothing is simulated twice");
  app.add_option("--store", o.store,
                 "evaluation store to use and to fill (default evaluations.sqlite in the run folder)");
  app.add_option("--max-walltime", o.max_walltime,
                 "end with a valid report after this time: 90 (minutes), 1:30:00, 2-12:00:00");
  app.add_option("--run-timeout", o.run_timeout_s,
                 "seconds after which one job of a worker counts as hanging (default 1800)")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", o.num_threads, "worker processes (default: all processors)")
      ->check(CLI::Range(0, 1024));
  app.add_option("--lanes", o.max_lanes, "at most this many parameter sets per pack: 1, 4 or 8")
      ->check(CLI::IsMember({0, 1, 4, 8}));
}

std::vector<std::string> problems(const SessionOptions& o) {
  std::vector<std::string> found;
  if (!o.max_walltime.empty() && !seconds_of_walltime(o.max_walltime))
    found.push_back(fmt::format("--max-walltime {}: is no time; write minutes, hours:minutes:seconds "
                                "or days-hours:minutes:seconds",
                                o.max_walltime));
  if (o.resume && o.out.empty())
    found.emplace_back("--resume needs --out: the folder of the run that shall go on");
  if (!o.store.empty() && fs::is_directory(o.store))
    found.push_back(fmt::format("--store {}: is a folder; name a file", o.store));
  return found;
}

fs::path open_run_folder(const SessionOptions& o, const std::string& stem,
                         const std::string& config_text) {
  const fs::path config = fs::path(o.out) / "config.json";
  if (o.resume && fs::exists(config)) {
    const std::vector<std::string> changed = config_differences(text_of(config), config_text);
    if (!changed.empty()) {
      std::vector<std::string> all = {fmt::format("--resume: {} was made for another run", o.out)};
      for (const std::string& c : changed) all.push_back(c);
      throw ConfigError(all);
    }
    if (::access(o.out.c_str(), W_OK) != 0)
      throw ConfigError({fmt::format("--out {}: cannot be written", o.out)});
    return o.out;
  }
  const fs::path folder = make_run_folder(o.out, stem);
  write_file(folder / "config.json", config_text);
  return folder;
}

RunSession::RunSession(const SessionOptions& o, const fs::path& folder)
    : folder_(folder),
      walltime_s_(seconds_of_walltime(o.max_walltime)),
      walltime_text_(o.max_walltime),
      start_(std::chrono::steady_clock::now()),
      lock_(folder),
      packings_(default_packing_folder(), solver_version),
      store_(std::make_unique<RunStore>(o.store.empty() ? folder / "evaluations.sqlite"
                                                        : fs::path(o.store))),
      workers_(std::make_unique<WorkerPool>(worker_command(o.max_lanes), threads_or_all(o.num_threads))),
      context_{packings_, threads_or_all(o.num_threads), o.max_lanes, &interrupt_flag(), nullptr} {
  BrokerOptions options;
  options.effort = expected_effort;
  options.run_timeout_s = o.run_timeout_s;
  options.stop = [this] { return wish(); };
  broker_ = std::make_unique<RunBroker>(*store_, *workers_, options);
  context_.broker = broker_.get();
  std::error_code none;
  fs::remove(folder / "STOP", none);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its write
}

StopWish RunSession::wish() const {
  if (interrupt_flag().load() || (walltime_s_ && seconds() > *walltime_s_)) return StopWish::at_once;
  return fs::exists(folder_ / "STOP") ? StopWish::finish_running : StopWish::none;
}

std::string RunSession::stop_reason() const {
  if (interrupt_flag().load()) return "stopped by a signal";
  if (walltime_s_ && seconds() > *walltime_s_)
    return fmt::format("--max-walltime {} reached", walltime_text_);
  return fs::exists(folder_ / "STOP") ? "a file STOP was found in the run folder" : "";
}

double RunSession::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string RunSession::store_note() const {
  std::size_t foreign = 0;
  for (const RunStore::Count& c : store_->counts())
    if (c.solver != solver_version) foreign += c.num_completed + c.num_failed + c.num_abandoned;
  if (foreign == 0) return "";
  return fmt::format("the store holds {} runs of another solver version: they are kept, but not used "
                     "by {} (calibrate cache ls shows them)",
                     foreign, solver_version);
}

}  // namespace tilth
