// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Packings cost as much as a test: made once, kept in memory and in a folder.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dem_core/packing.hpp"

namespace tilth {

/// Everything that influences a packing, as one line; equal keys mean equal packings.
std::string packing_key(const PackingSpec& spec);

/// $XDG_CACHE_HOME/tilth/packings or ~/.cache/tilth/packings; empty if neither variable is set.
std::filesystem::path default_packing_folder();

/// Gives packings by specification. A stored file is used only if its first line is the key itself;
/// an unreadable folder only costs time, never a run.
/// @thread_safety all members may be called from several threads; one packing is made by one of them.
class PackingStore {
 public:
  /// An empty folder keeps packings in memory only, an empty version the numbers.
  /// @param version of the program: numbers measured by another one are not used
  explicit PackingStore(std::filesystem::path folder = {}, std::string version = {});

  /// @pre problems(spec) is empty
  std::shared_ptr<const Packing> get(const PackingSpec& spec);

  /// What is measured on a packing once, such as the void ratio of its densest state.
  /// `make` is called again for a key only if it gave nothing (a run that was stopped).
  using Numbers = std::vector<double>;
  Numbers numbers(const std::string& key, const std::function<Numbers()>& make);

 private:
  struct Slot {
    std::once_flag made;
    std::shared_ptr<const Packing> packing;
  };
  std::filesystem::path file_of(const std::string& key) const;

  std::filesystem::path folder_;
  std::string version_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Slot>> slots_;
  std::mutex numbers_mutex_;
  std::map<std::string, Numbers> numbers_;
};

/// Text with hexadecimal floats: exact. Returns nothing where the file is absent or not of this key.
std::shared_ptr<const Packing> read_packing(const std::filesystem::path& file,
                                            const std::string& key);

/// Written beside and renamed, so that a reader never sees half a file. False if it cannot be written.
bool write_packing(const std::filesystem::path& file, const std::string& key,
                   const Packing& packing);

}  // namespace tilth
