// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A fit whose simulations crash, hang and give NaN, and which is killed ten times.
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "calibrate/run_store.hpp"
#include "tests/calibrate/formula_models.hpp"
#include "tests/calibrate/soil_folder.hpp"
#include "tests/cli/program_run.hpp"

using namespace tilth;
using namespace tilth::test;
using cli_test::TempFolder;

extern char** environ;

namespace {

pid_t start(const std::string& store, const std::string& out, const std::string& faults) {
  std::vector<std::string> words = {TILTH_FORMULA_PROGRAM, "fit", store, out};
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  if (faults.empty()) ::unsetenv("TILTH_FAULTS");
  else ::setenv("TILTH_FAULTS", faults.c_str(), 1);
  pid_t pid = -1;
  REQUIRE(::posix_spawn(&pid, words[0].c_str(), nullptr, nullptr, arguments.data(), environ) == 0);
  ::unsetenv("TILTH_FAULTS");
  return pid;
}

int ended(pid_t pid) {
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("Faults: crashes, hangs, NaN and ten kills change no bit of the answer and repeat no run",
          "[calibrate][faults]") {
  const TempFolder folder("faults");
  const std::string marks = folder / "marks";
  std::filesystem::create_directory(marks);
  REQUIRE(ended(start(folder / "calm.sqlite", folder / "calm.txt", "")) == 0);
  const std::string calm = soil_test::read_text(folder / "calm.txt");

  const std::string faults = "crash=0.1,hang=0.05,nan=0.05,dir=" + marks;
  for (std::uint64_t kill = 0; kill < 10; ++kill) {
    const pid_t pid = start(folder / "rough.sqlite", folder / "rough.txt", faults);
    const double share = 0.5 + 0.5 * std::erf(normal_number(1, kill, 0));
    std::this_thread::sleep_for(std::chrono::milliseconds(30 + static_cast<int>(200 * share)));
    ::kill(pid, SIGKILL);
    ended(pid);
  }
  REQUIRE(ended(start(folder / "rough.sqlite", folder / "rough.txt", faults)) == 0);

  CHECK(soil_test::read_text(folder / "rough.txt") == calm);
  const RunStore calm_store(folder / "calm.sqlite"), rough_store(folder / "rough.sqlite");
  CHECK(rough_store.num_repeats() == 0);
  CHECK(rough_store.keys().size() == calm_store.keys().size());
  for (const std::string& key : rough_store.keys())
    CHECK(rough_store.find(key)->state == RunState::completed);
  // the faults did happen
  const auto num_marks = std::distance(std::filesystem::directory_iterator(marks), {});
  CHECK(num_marks > 10);
}
