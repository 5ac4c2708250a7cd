// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/program_run.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "calibrate/cli/program.hpp"
#include "tests/calibrate/soil_folder.hpp"

namespace tilth::cli_test {
namespace fs = std::filesystem;
namespace {

/// Sends a stream into a text while it lives.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), old_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(old_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* old_;
};

pid_t start(const std::vector<std::string>& arguments, const fs::path& folder) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), TILTH_PROGRAM);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string output = folder / "stdout.txt";
  const std::string errors = folder / "stderr.txt";
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child > 0) return child;
  const bool ready =
      ::chdir(folder.c_str()) == 0 &&
      ::dup2(::open(output.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644), STDOUT_FILENO) >= 0 &&
      ::dup2(::open(errors.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644), STDERR_FILENO) >= 0;
  if (ready) ::execv(argv[0], argv.data());
  ::_exit(127);
}

ProgramRun finish(pid_t child, const fs::path& folder) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          soil_test::read_text(folder / "stdout.txt"), soil_test::read_text(folder / "stderr.txt")};
}

}  // namespace

TempFolder::TempFolder(const std::string& test_name)
    : path_(fs::temp_directory_path() /
            ("tilth_cli_test_" + test_name + "_" + std::to_string(::getpid()))) {
  fs::remove_all(path_);
  fs::create_directories(path_);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string TempFolder::write(const std::string& name, const std::string& text) const {
  soil_test::write_text(path_ / name, text);
  return (path_ / name).string();
}

bool ProgramRun::says(const std::vector<std::string>& parts) const {
  for (const std::string& part : parts)
    if (errors.find(part) == std::string::npos) return false;
  return true;
}

ProgramRun run(const std::vector<std::string>& arguments) {
  ::setenv("TILTH_WORKER_PROGRAM", TILTH_PROGRAM, 0);  // this program cannot be its own worker
  std::vector<const char*> argv = {"calibrate"};
  for (const std::string& a : arguments) argv.push_back(a.c_str());
  const Captured output(std::cout);
  const Captured errors(std::cerr);
  const int code = run_program(static_cast<int>(argv.size()), argv.data());
  return {code, output.text(), errors.text()};
}

ProgramRun run_process(const std::vector<std::string>& arguments, const fs::path& folder) {
  return finish(start(arguments, folder), folder);
}

ProgramRun run_and_do(const std::vector<std::string>& arguments, const fs::path& folder,
                      const std::string& cue, const std::function<void(pid_t)>& deed) {
  const pid_t child = start(arguments, folder);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  const auto last = now() + std::chrono::seconds(60);
  while (now() < last &&
         soil_test::read_text(folder / "stderr.txt").find(cue) == std::string::npos)
    pause();
  deed(child);
  siginfo_t info{};
  while (now() < last && info.si_pid == 0) {
    ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT);
    pause();
  }
  if (info.si_pid == 0) ::kill(child, SIGKILL);
  return finish(child, folder);
}

ProgramRun run_and_signal(const std::vector<std::string>& arguments, const fs::path& folder,
                          const std::string& cue, int signal) {
  return run_and_do(arguments, folder, cue, [signal](pid_t child) { ::kill(child, signal); });
}

std::string one_test_soil(const TempFolder& folder) {
  const fs::path soil = folder.path() / "loamy_sand";
  soil_test::copy_without_tracers("loamy_sand", soil);
  soil_test::write_text(
      soil / "measurements.csv",
      "testId,observableId,conditionId,xId,x,value,sigma,sigma_kind,replicateId,weight,holdout,"
      "provenance,observation_group,source,locator\n"
      "unconfined_compression,peak_stress_Pa,unconfined_drained,,,14160,0.3,log,,1,0,synthetic,"
      "peak,test,test\n"
      "unconfined_compression,secant_modulus_Pa,unconfined_drained,,,3e6,0.3,log,,1,0,synthetic,"
      "modulus,test,test\n"
      "unconfined_compression,strain_at_peak,unconfined_drained,,,0.005,1.0,log,,1,1,synthetic,"
      "strain,test,test\n");
  return soil.string();
}

std::string tiny_config(const std::string& more) {
  return R"({ "schema": "tilth.fit/1", "parameters": [ { "name": "friction", "value": 0.5 } ],
  "fit": { "num_design": 3, "num_noise_seeds": 2, "num_search_seeds": 1, "num_confirm_seeds": 1,
           "num_fresh_seeds": 1, "num_rounds": 1, "round_size": 2, "num_starts": 1,
           "max_iterations": 4, "max_bias_rounds": 1, "chi_square_tolerance": 0.2)" +
         more + " } }\n";
}

}  // namespace tilth::cli_test
