// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/test_runs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "calibrate/cli/solver_version.hpp"
#include "calibrate/parallel.hpp"

namespace tilth {
namespace {

std::string text_of(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& f : fields) text += std::string(f.name) + "=" + field_text(f) + "\n";
  return text;
}

void read_fields(const std::string& text, const std::vector<Field>& fields) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find('=');
    const Field* field = find_field(fields, line.substr(0, at));
    if (!field || at == std::string::npos) throw std::runtime_error("unknown setting " + line);
    const std::string value = line.substr(at + 1);
    if (auto* list = std::get_if<std::vector<double>*>(&field->value); list && value.empty())
      (*list)->clear();
    else if (const std::string wrong = set_field(*field, value); !wrong.empty())
      throw std::runtime_error(wrong);
  }
}

std::uint64_t seed_in(const std::vector<Field>& fields) {
  const Field* seed = find_field(fields, "packing_seed");
  return seed ? *std::get<std::uint64_t*>(seed->value) : 0;
}

struct Ending {
  RunStatus status = RunStatus::lost;
  std::string message;
};

/// RunRecord::reason of a test: "diverged: overlap of 0.4 radii".
std::string reason_of(const Ending& e) { return std::string(name_of(e.status)) + ": " + e.message; }

/// The way back; lost, in all its words, where no test has written the reason.
Ending ending_of(const std::string& reason) {
  const std::size_t colon = reason.find(": ");
  for (const RunStatus s : {RunStatus::completed, RunStatus::diverged, RunStatus::not_settled})
    if (colon != std::string::npos && reason.substr(0, colon) == name_of(s))
      return {s, reason.substr(colon + 2)};
  return {RunStatus::lost, reason};
}

/// Runs of equal setups, as places in the list.
std::vector<std::vector<std::size_t>> groups_of(std::span<const TestRun> runs) {
  std::vector<std::string> setups;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunIdentity identity = identity_of(runs[k]);
    const std::string setup = identity.test + "\n" + identity.setup;
    const auto at = static_cast<std::size_t>(std::ranges::find(setups, setup) - setups.begin());
    if (at == setups.size()) {
      setups.push_back(setup);
      groups.emplace_back();
    }
    groups[at].push_back(k);
  }
  return groups;
}

std::vector<ExperimentResult> run_here(std::span<const TestRun> runs, const RunContext& context) {
  const std::vector<std::vector<std::size_t>> groups = groups_of(runs);
  std::vector<ExperimentResult> results(runs.size());
  // Every setup is a task of its own: one member on several packings fills the threads as well as
  // several members on one.
  parallel_for_each_index(groups.size(), context.num_threads, [&](std::size_t g) {
    std::vector<SoilMaterial> members;
    for (const std::size_t k : groups[g]) members.push_back(runs[k].material);
    std::vector<ExperimentResult> own =
        run_virtual_test(runs[groups[g].front()].config, members, context.packings,
                         run_options(context, runs.size()));
    for (std::size_t m = 0; m < own.size(); ++m) results[groups[g][m]] = std::move(own[m]);
  });
  return results;
}

}  // namespace

RunOptions run_options(const RunContext& context, std::size_t num_runs) {
  RunOptions options;
  options.max_lanes = context.max_lanes;
  options.stop = context.stop;
  options.for_each = [n = context.num_threads](std::size_t count, const auto& body) {
    parallel_for_each_index(count, n, body);
  };
  options.threads_per_pack = std::max(1, context.num_threads / static_cast<int>(std::max<std::size_t>(1, num_runs)));
  if (options.threads_per_pack > 1) options.side_by_side = thread_team(options.threads_per_pack);
  return options;
}

std::vector<ExperimentResult> run_tests(std::span<const TestRun> runs, const RunContext& context) {
  if (!context.broker) return run_here(runs, context);
  std::vector<RunIdentity> wanted;
  for (const TestRun& run : runs) wanted.push_back(identity_of(run));
  std::vector<ExperimentResult> results;
  for (const RunRecord& record : context.broker->run(wanted)) results.push_back(result_of(record));
  return results;
}

RunIdentity identity_of(const TestRun& run) {
  TestConfig config = run.config;
  SoilMaterial material = run.material;
  const std::vector<Field> settings = fields(config);
  return {solver_version, test_id(config), run.condition_id, seed_in(settings), text_of(settings),
          text_of(fields(material))};
}

TestRun run_of(const RunIdentity& identity) {
  TestRun run{virtual_test(identity.test, Fidelity::search), identity.condition, {}};
  read_fields(identity.setup, fields(run.config));
  read_fields(identity.material, fields(run.material));
  return run;
}

RunRecord record_of(const ExperimentResult& r) {
  RunRecord record;
  // The same run ends the same way each time: what did not complete is not tried again.
  record.state = r.status == RunStatus::completed ? RunState::completed
                 : r.status == RunStatus::stopped ? RunState::candidate
                                                  : RunState::abandoned;
  record.reason = reason_of({r.status, r.message});
  record.dt_s = r.dt_s;
  record.num_steps = r.num_steps;
  record.inertial_number = r.inertial_number;
  for (const Feature& f : r.features) record.features.push_back({f.name, f.value});
  for (const Curve& c : r.curves) record.curves.push_back({c.name, c.columns, c.rows});
  return record;
}

ExperimentResult result_of(const RunRecord& record) {
  ExperimentResult r;
  r.message = record.reason;
  r.dt_s = record.dt_s;
  r.num_steps = record.num_steps;
  r.inertial_number = record.inertial_number;
  for (const NamedTable& c : record.curves) r.curves.push_back({c.name, c.columns, c.rows});
  for (const NamedNumber& f : record.features) r.features.push_back({f.name, f.value});
  if (record.state == RunState::completed || record.state == RunState::abandoned) {
    Ending ending = ending_of(record.reason);
    r.status = ending.status;
    r.message = std::move(ending.message);
  }
  return r;
}

double expected_effort(const RunIdentity& identity) {
  const SoilMaterial m = run_of(identity).material;
  const double modulus_Pa = std::max({m.contact_modulus_Pa, m.bond.modulus_Pa, 1.0});
  const bool runs_in_real_time = identity.test == "sweep_tillage" || identity.test == "cone_penetration" ||
                                 identity.test == "angle_of_repose";
  return runs_in_real_time ? std::sqrt(modulus_Pa) : m.bond.tensile_strength_Pa / modulus_Pa;
}

std::vector<RunRecord> simulate_members(std::span<const RunIdentity> members, PackingStore& packings,
                                        int max_lanes) {
  std::vector<SoilMaterial> materials;
  for (const RunIdentity& m : members) materials.push_back(run_of(m).material);
  RunOptions options;
  options.max_lanes = max_lanes;
  std::vector<RunRecord> records;
  for (const ExperimentResult& r :
       run_virtual_test(run_of(members.front()).config, materials, packings, options))
    records.push_back(record_of(r));
  return records;
}

}  // namespace tilth
