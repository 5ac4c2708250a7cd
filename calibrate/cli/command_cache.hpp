// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate cache`: what is in an evaluation store.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace tilth {

struct CacheOptions {
  std::string action;  ///< "ls", "show", "remove", "merge"
  std::string store;   ///< a file, or the run folder that holds it
  std::vector<std::string> others;  ///< merge: files, run folders, or answer messages (*.json)
  std::string key;     ///< show, remove: the first digits of a key
  std::string test;
  bool only_failed = false;
  bool other_solvers = false;
  bool all = false;
};

void add_cache_options(CLI::App& command, CacheOptions& options);
int run_cache(const CacheOptions& options);

}  // namespace tilth
