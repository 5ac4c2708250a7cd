// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_broker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "calibrate/run_message.hpp"

namespace tilth {
namespace {

/// Runs of one group may share a pack.
std::string group_of(const RunIdentity& i) { return i.solver + "\n" + i.test + "\n" + i.setup; }

bool is_final(RunState state) {
  return state == RunState::completed || state == RunState::abandoned;
}

/// A completed run with a number that is not finite is a failed one.
void check_numbers(RunRecord& r) {
  if (r.state != RunState::completed) return;
  for (const NamedNumber& f : r.features)
    if (!std::isfinite(f.value)) {
      r.state = RunState::failed;
      r.reason = f.name + " is not finite";
    }
}

}  // namespace

struct RunBroker::Job {
  std::vector<std::size_t> members;  ///< places in the call's list
};

std::size_t members_per_job(std::size_t num_members, int num_workers, int max_members) {
  const auto workers = static_cast<std::size_t>(std::max(1, num_workers));
  const std::size_t share = (num_members + workers - 1) / workers;
  return std::clamp<std::size_t>(share, 1, static_cast<std::size_t>(std::max(1, max_members)));
}

RunBroker::RunBroker(RunStore& store, WorkerPool& workers, BrokerOptions options)
    : store_(store), workers_(workers), options_(std::move(options)) {}

std::vector<RunBroker::Job> RunBroker::plan(const std::vector<std::size_t>& missing,
                                            const std::vector<RunRecord>& records) const {
  std::map<std::string, std::vector<std::size_t>> groups;
  std::vector<std::string> order;
  for (const std::size_t k : missing) {
    const std::string group = group_of(records[k].identity);
    if (!groups.contains(group)) order.push_back(group);
    groups[group].push_back(k);
  }
  std::vector<Job> jobs;
  for (const std::string& group : order) {
    const std::vector<std::size_t>& all = groups[group];
    const int share = static_cast<int>(
        std::max<std::size_t>(1, static_cast<std::size_t>(workers_.num_workers()) / order.size()));
    const std::size_t size = members_per_job(all.size(), share, options_.max_members);
    for (std::size_t at = 0; at < all.size(); at += size)
      jobs.push_back({{all.begin() + static_cast<std::ptrdiff_t>(at),
                       all.begin() + static_cast<std::ptrdiff_t>(std::min(at + size, all.size()))}});
  }
  return jobs;
}

std::vector<RunRecord> RunBroker::run(std::span<const RunIdentity> wanted) {
  std::vector<RunRecord> records(wanted.size());
  std::vector<std::size_t> missing;
  std::map<std::string, std::size_t> first_of_key;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    records[k].identity = wanted[k];
    records[k].key = run_key(wanted[k]);
    if (!first_of_key.emplace(records[k].key, k).second) continue;  // asked for twice: simulated once
    if (auto known = store_.find(records[k].key)) {
      records[k] = std::move(*known);
      records[k].identity.condition = wanted[k].condition;
    }
    if (is_final(records[k].state)) ++counts_.num_from_store;
    else missing.push_back(k);
  }

  std::vector<Job> jobs = plan(missing, records);
  const auto message = [&](const Job& job) {
    std::vector<RunIdentity> members;
    for (const std::size_t k : job.members) members.push_back(records[k].identity);
    return request_message(members);
  };
  std::vector<std::string> requests;
  for (const Job& job : jobs) requests.push_back(message(job));
  std::size_t num_done = wanted.size() - missing.size();

  const auto start_alone = [&](std::size_t k, std::vector<std::string>& more) {
    ++counts_.num_retries;
    jobs.push_back({{k}});
    more.push_back(message(jobs.back()));
  };
  const auto count_try = [&](RunRecord& r, const std::string& reason) {
    ++r.num_tries;
    r.reason = reason;
    r.state = r.num_tries < options_.max_tries ? RunState::failed : RunState::abandoned;
    if (r.state == RunState::abandoned)
      r.reason += fmt::format(" ({} tries)", r.num_tries);
  };
  const auto take_answer = [&](const JobOutcome& outcome, const Job& job) {
    std::vector<RunRecord> answer = read_answer(outcome.answer);
    if (answer.size() != job.members.size())
      throw std::runtime_error("a worker answered another number of runs than it was asked for");
    for (std::size_t m = 0; m < answer.size(); ++m) {
      RunRecord& r = records[job.members[m]];
      check_numbers(answer[m]);
      answer[m].num_tries = r.num_tries;
      answer[m].wall_s = outcome.wall_s / static_cast<double>(answer.size());
      answer[m].key = r.key;
      answer[m].identity = r.identity;
      r = std::move(answer[m]);
      if (r.state == RunState::failed) count_try(r, std::string(r.reason));
      else if (is_final(r.state)) ++r.num_tries;
    }
  };
  const auto on_end = [&](const JobOutcome& outcome) {
    const Job job = jobs[outcome.job];
    counts_.busy_s += outcome.wall_s;
    std::vector<std::string> more;
    if (outcome.end == JobEnd::answered) take_answer(outcome, job);
    else if (job.members.size() == 1) count_try(records[job.members.front()], outcome.reason);
    std::vector<RunRecord> ended;
    for (const std::size_t k : job.members) {
      const RunRecord& r = records[k];
      if (r.state == RunState::candidate || r.state == RunState::failed) start_alone(k, more);
      if (r.state == RunState::candidate) continue;
      if (is_final(r.state)) ++counts_.num_simulated, ++num_done;
      ended.push_back(r);
    }
    store_.add(ended);
    if (options_.progress) options_.progress(num_done, wanted.size());
    return more;
  };
  workers_.run(std::move(requests), options_.run_timeout_s, options_.stop, on_end);

  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const std::size_t first = first_of_key[records[k].key];
    if (first != k) records[k] = records[first];
  }
  return records;
}

}  // namespace tilth
