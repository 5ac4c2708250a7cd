// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The program as a user runs it: inside the test for speed, as a process where that matters.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tilth::cli_test {

/// A folder under the temporary folder, removed at the end.
class TempFolder {
 public:
  explicit TempFolder(const std::string& test_name);
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Path of a file in it.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and gives its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< standard output
  std::string errors;  ///< standard error; of the log only what a real process writes
  /// True when standard error holds all parts.
  bool says(const std::vector<std::string>& parts) const;
};

/// run_program() with these arguments.
ProgramRun run(const std::vector<std::string>& arguments);

/// The built program, in a folder of its own choice.
ProgramRun run_process(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder);

/// The built program; once its standard error holds `cue`, `deed` is done with its process id. Killed
/// after 60 s.
ProgramRun run_and_do(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                      const std::string& cue, const std::function<void(pid_t)>& deed);

/// The same with a signal as the deed.
ProgramRun run_and_signal(const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, const std::string& cue, int signal);

/// A soil that needs one cheap test only: unconfined peak and modulus, strain at the peak held out.
/// Two observations: hold friction to fit it.
std::string one_test_soil(const TempFolder& folder);

/// Text of a config that fits one_test_soil() in a few seconds; `more` goes into "fit".
std::string tiny_config(const std::string& more = "");

}  // namespace tilth::cli_test
