// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One child process that answers lines with lines.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace tilth {

/// A child that reads requests from its standard input and writes answers to its standard output,
/// one line each; what it says on standard error is kept, the last 2000 characters of it.
/// The child is killed with the object. @limits POSIX
class WorkerProcess {
 public:
  /// @throws std::runtime_error if the program cannot be started
  explicit WorkerProcess(const std::vector<std::string>& command);
  ~WorkerProcess();
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&&) = delete;

  /// False if the child is gone.
  bool send(const std::string& line);
  int answer_fd() const { return out_; }
  int error_fd() const { return err_; }
  /// Takes what is there without waiting. False once the child has closed its output.
  bool read_answer();
  void read_errors();
  /// A whole line of the answer, if there is one.
  std::optional<std::string> next_line();
  const std::string& last_words() const { return words_; }
  /// Kills the child and says how it ended: "killed by signal 11", "exit code 3".
  std::string end();

 private:
  pid_t pid_ = -1;
  int in_ = -1, out_ = -1, err_ = -1;
  std::string answer_;
  std::string words_;
};

}  // namespace tilth
