// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/command_cache.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <span>

#include "calibrate/cli/exit_code.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/run_message.hpp"
#include "calibrate/run_store.hpp"

namespace tilth {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t max_shown = 20;

fs::path store_file(const std::string& name) {
  return fs::is_directory(name) ? fs::path(name) / "evaluations.sqlite" : fs::path(name);
}

int list(const RunStore& store) {
  std::cout << fmt::format("{:<36} {:<24} {:>9} {:>7} {:>9} {:>10}\n", "solver", "test", "COMPLETED",
                           "FAILED", "ABANDONED", "worker s");
  for (const RunStore::Count& c : store.counts())
    std::cout << fmt::format("{:<36} {:<24} {:>9} {:>7} {:>9} {:>10.1f}\n",
                             c.solver + (c.solver == solver_version ? " *" : ""), c.test,
                             c.num_completed, c.num_failed, c.num_abandoned, c.wall_s);
  std::cout << "* the version of this program: only these are used by it\n"
               "FAILED: for a reason that may pass, tried again; ABANDONED: never tried again\n";
  return exit_done;
}

std::string reason_to_show(const RunRecord& r) {
  return r.state == RunState::completed ? "" : r.reason;
}

void show_one(const RunRecord& r) {
  std::cout << fmt::format("key {}\n{} {} ({} tries)\n{} under {}, packing {}, {}\n", r.key,
                           to_string(r.state), reason_to_show(r), r.num_tries, r.identity.test,
                           r.identity.condition, r.identity.seed, r.identity.solver);
  std::cout << fmt::format("time step {:.6g} s, {} steps, inertial number {:.3g}, {:.3g} s on {}\n",
                           r.dt_s, r.num_steps, r.inertial_number, r.wall_s, r.host);
  for (const NamedNumber& f : r.features) std::cout << fmt::format("  {:<40} {:.9g}\n", f.name, f.value);
  for (const NamedTable& c : r.curves)
    std::cout << fmt::format("  curve {}: {} rows of {} columns\n", c.name, c.rows.size(), c.columns.size());
  std::cout << "setup\n" << r.identity.setup << "material\n" << r.identity.material << '\n';
}

int show(const RunStore& store, const CacheOptions& o) {
  const std::vector<std::string> keys = store.keys(o.key);
  if (keys.empty()) throw ConfigError({fmt::format("no run whose key begins with '{}'", o.key)});
  if (keys.size() == 1) {
    show_one(*store.find(keys.front()));
    return exit_done;
  }
  const std::size_t num_shown = std::min(keys.size(), max_shown);
  for (const std::string& key : std::span(keys).first(num_shown)) {
    const RunRecord r = *store.find(key);
    std::cout << fmt::format("{} {:<9} {:<22} {:<16} packing {:<6} {}\n", key.substr(0, 12),
                             to_string(r.state), r.identity.test, r.identity.condition,
                             r.identity.seed, reason_to_show(r));
  }
  std::cout << fmt::format("{} of {} runs shown; --key with the first digits of a key selects\n",
                           num_shown, keys.size());
  return exit_done;
}

int remove(RunStore& store, const CacheOptions& o) {
  if (!o.all && o.key.empty() && o.test.empty() && !o.only_failed && !o.other_solvers)
    throw ConfigError({"cache remove: say what: --key, --test, --failed, --other-solvers or --all"});
  const std::size_t n = store.remove({o.other_solvers ? solver_version : "", o.test, o.key, o.only_failed});
  std::cout << fmt::format("{} runs removed\n", n);
  return exit_done;
}

/// Runs of a worker elsewhere, kept as the message it sent.
std::size_t take_message(RunStore& store, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::vector<RunRecord> taken;
  for (RunRecord& r : read_answer(text)) {
    if (r.key != run_key(r.identity))
      throw ConfigError({fmt::format("{}: the key {} is not that of its content", file.string(), r.key)});
    if (r.state != RunState::candidate && store.lacks(r.key)) taken.push_back(std::move(r));
  }
  store.add(taken);
  return taken.size();
}

int merge(RunStore& store, const CacheOptions& o) {
  for (const std::string& name : o.others) {
    std::size_t n = 0;
    try {
      n = fs::path(name).extension() == ".json"
              ? take_message(store, name)
              : store.merge(RunStore(store_file(name), RunStore::Mode::read_only));
    } catch (const std::runtime_error& e) {
      throw ConfigError({fmt::format("{}: {}", name, e.what())});
    }
    std::cout << fmt::format("{} runs taken from {}\n", n, name);
  }
  return exit_done;
}

}  // namespace

void add_cache_options(CLI::App& command, CacheOptions& o) {
  command.add_option("action", o.action, "ls, show, remove or merge")
      ->required()
      ->check(CLI::IsMember({"ls", "show", "remove", "merge"}));
  command.add_option("store", o.store, "evaluations.sqlite, or the run folder that holds it")->required();
  command.add_option("others", o.others, "merge: stores, run folders or workers' answers (*.json)");
  command.add_option("--key", o.key, "show, remove: first digits of the key");
  command.add_option("--test", o.test, "remove: runs of this test");
  command.add_flag("--failed", o.only_failed, "remove: FAILED and ABANDONED runs, so that they are tried again");
  command.add_flag("--other-solvers", o.other_solvers, "remove: runs of other versions of the solver");
  command.add_flag("--all", o.all, "remove: everything");
}

int run_cache(const CacheOptions& o) {
  using enum RunStore::Mode;
  if (o.action == "merge" && o.others.empty())
    throw ConfigError({"cache merge: name what shall be taken over"});
  RunStore store(store_file(o.store), o.action == "merge"    ? make
                                      : o.action == "remove" ? read_write
                                                             : read_only);
  if (o.action == "ls") return list(store);
  if (o.action == "show") return show(store, o);
  if (o.action == "remove") return remove(store, o);
  return merge(store, o);
}

}  // namespace tilth
