// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/worker_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace tilth {
namespace {

constexpr std::size_t max_words = 2000;

/// Both ends are closed in children that are started later.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error(fmt::format("no pipe to a worker: {}", std::strerror(errno)));
  return ends;
}

void close_fd(int& fd) {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

/// Appends what can be read now. False at the end of the file.
bool drain(int fd, std::string& into) {
  std::array<char, 65536> buffer{};
  for (;;) {
    const ssize_t n = ::read(fd, buffer.data(), buffer.size());
    if (n > 0) into.append(buffer.data(), static_cast<std::size_t>(n));
    else if (n == 0) return false;
    else if (errno != EINTR) return errno == EAGAIN || errno == EWOULDBLOCK;
  }
}

}  // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& command) {
  auto [child_in, parent_in] = make_pipe();
  auto [parent_out, child_out] = make_pipe();
  auto [parent_err, child_err] = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, child_in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, child_out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, child_err, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int wrong = ::posix_spawnp(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  for (int* fd : {&child_in, &child_out, &child_err}) close_fd(*fd);
  in_ = parent_in, out_ = parent_out, err_ = parent_err;
  for (const int fd : {out_, err_}) ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  if (wrong != 0) {
    pid_ = -1;
    end();
    throw std::runtime_error(fmt::format("cannot start {}: {}", command[0], std::strerror(wrong)));
  }
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      in_(std::exchange(other.in_, -1)),
      out_(std::exchange(other.out_, -1)),
      err_(std::exchange(other.err_, -1)),
      answer_(std::move(other.answer_)),
      words_(std::move(other.words_)) {}

WorkerProcess::~WorkerProcess() { end(); }

bool WorkerProcess::send(const std::string& line) {
  const std::string text = line + "\n";
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(in_, text.data() + at, text.size() - at);
    if (n > 0) at += static_cast<std::size_t>(n);
    else if (errno != EINTR) return false;
  }
  return true;
}

bool WorkerProcess::read_answer() { return drain(out_, answer_); }

void WorkerProcess::read_errors() {
  if (!drain(err_, words_)) close_fd(err_);
  if (words_.size() > max_words) words_.erase(0, words_.size() - max_words);
}

std::optional<std::string> WorkerProcess::next_line() {
  const std::size_t end = answer_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = answer_.substr(0, end);
  answer_.erase(0, end + 1);
  return line;
}

std::string WorkerProcess::end() {
  std::string how = "ended before";
  if (pid_ > 0) {
    int status = 0;
    // one that has died by itself keeps its own cause
    if (::waitpid(pid_, &status, WNOHANG) == 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, &status, 0);
    }
    how = WIFSIGNALED(status) ? fmt::format("killed by signal {}", WTERMSIG(status))
                              : fmt::format("exit code {}", WEXITSTATUS(status));
    pid_ = -1;
  }
  if (err_ >= 0) read_errors();
  for (int* fd : {&in_, &out_, &err_}) close_fd(*fd);
  return how;
}

}  // namespace tilth
