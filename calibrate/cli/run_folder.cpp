// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/run_folder.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>

#include "calibrate/config_error.hpp"

namespace tilth {
namespace fs = std::filesystem;
namespace {

fs::path first_free(const std::string& stem) {
  for (int n = 1;; ++n) {
    const fs::path folder = fs::path("runs") / fmt::format("{}-{}", stem, n);
    if (!fs::exists(folder)) return folder;
  }
}

void back_up(const fs::path& folder) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const std::string base =
      fmt::format("{}.backup-{:%Y%m%d-%H%M%S}", folder.string(), fmt::localtime(now));
  fs::path target = base;
  for (int n = 2; fs::exists(target); ++n) target = fmt::format("{}-{}", base, n);
  fs::rename(folder, target);
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder)
    : fd_(::open((folder / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
  if (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) == 0) return;
  if (fd_ >= 0) ::close(fd_);
  throw ConfigError({fmt::format("--out {}: another calibrate is working in this folder; name another "
                                 "one, or share its runs with --store {}",
                                 folder.string(), (folder / "evaluations.sqlite").string())});
}

FolderLock::~FolderLock() { ::close(fd_); }

fs::path make_run_folder(const fs::path& wanted, const std::string& stem) {
  fs::path folder = wanted.empty() ? first_free(stem) : wanted;
  if (!folder.has_filename()) folder = folder.parent_path();
  try {
    if (fs::exists(folder) && !fs::is_directory(folder))
      throw ConfigError({fmt::format("--out {}: is a file, not a folder", folder.string())});
    if (fs::exists(folder) && !fs::is_empty(folder)) {
      if (fs::exists(folder / ".lock")) const FolderLock nobody_is_in(folder);
      back_up(folder);
    }
    fs::create_directories(folder);
    const fs::path probe = folder / ".writable";
    std::ofstream(probe) << "x";
    if (!fs::exists(probe)) throw fs::filesystem_error("", folder, std::error_code());
    fs::remove(probe);
  } catch (const fs::filesystem_error& e) {
    throw ConfigError({fmt::format("--out {}: cannot be written ({}); name another folder",
                                   folder.string(),
                                   e.code() ? e.code().message() : "no file can be made in it")});
  }
  return folder;
}

void write_file(const fs::path& file, const std::string& text) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  const fs::path draft = file.string() + ".part";
  errno = 0;
  std::ofstream out(draft, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    const int reason = errno;
    std::error_code ignored;
    fs::remove(draft, ignored);
    throw WriteError("cannot write " + file.string() + (reason ? std::string(" (") + std::strerror(reason) + ")" : "") +
                     ": what was simulated is kept, go on with --resume");
  }
  fs::rename(draft, file);
}

}  // namespace tilth
