// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The output folder: made before anything is computed, files appear whole or not at all.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace tilth {

/// Holds a run folder for one program: an advisory lock on its file ".lock", given up with the object
/// or the process, however that ends.
class FolderLock {
 public:
  /// @throws ConfigError if another program works in the folder
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_ = -1;
};

/// Makes the folder and checks that it can be written. An existing folder that is not empty is
/// moved to "<folder>.backup-<date>-<time>" first. An empty name becomes runs/<stem>-<n> with the
/// first free n.
/// @throws ConfigError if it cannot be made or written, or if another program works in it
std::filesystem::path make_run_folder(const std::filesystem::path& wanted, const std::string& stem);

/// The disk is full, or a file cannot be made: no bug, and nothing that is in the store is lost.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes beside and renames. Folders on the way are made.
/// @throws WriteError with path and reason
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace tilth
