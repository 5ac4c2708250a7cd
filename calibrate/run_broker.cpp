// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_broker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
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

/// A completed run with a number that is not finite is a failed one, and so is one that was not run.
void check_answer(RunRecord& r) {
  if (r.state == RunState::candidate) {
    r.state = RunState::failed;
    r.reason = "the worker answered without having run it";
  }
  if (r.state != RunState::completed) return;
  for (const NamedNumber& f : r.features)
    if (!std::isfinite(f.value)) {
      r.state = RunState::failed;
      r.reason = f.name + " is not finite";
    }
}

}  // namespace

/// One call of run().
struct RunBroker::Call {
  std::vector<RunRecord> records;  ///< one per run asked for
  std::map<std::string, std::size_t> first_of_key;
  std::vector<Job> jobs;
  std::size_t num_done = 0;
};

std::size_t members_per_job(std::size_t num_members, int num_workers, int max_members) {
  const auto workers = static_cast<std::size_t>(std::max(1, num_workers));
  const std::size_t share = (num_members + workers - 1) / workers;
  return std::clamp<std::size_t>(share, 1, static_cast<std::size_t>(std::max(1, max_members)));
}

std::vector<std::vector<std::size_t>> jobs_of_like_effort(std::vector<std::size_t> runs,
                                                          const std::function<double(std::size_t)>& effort,
                                                          std::size_t size) {
  if (effort) {
    std::map<std::size_t, double> efforts;
    for (const std::size_t k : runs) efforts[k] = effort(k);
    std::ranges::stable_sort(runs, std::ranges::greater(), [&](std::size_t k) { return efforts.at(k); });
  }
  std::vector<std::vector<std::size_t>> jobs;
  for (std::size_t at = 0; at < runs.size(); at += size)
    jobs.emplace_back(runs.begin() + static_cast<std::ptrdiff_t>(at),
                      runs.begin() + static_cast<std::ptrdiff_t>(std::min(at + size, runs.size())));
  return jobs;
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
    std::function<double(std::size_t)> effort;
    if (options_.effort) effort = [&](std::size_t k) { return options_.effort(records[k].identity); };
    for (auto& job : jobs_of_like_effort(all, effort, members_per_job(all.size(), share, options_.max_members)))
      jobs.emplace_back(job.begin(), job.end());
  }
  return jobs;
}

std::vector<std::size_t> RunBroker::look_up(std::span<const RunIdentity> wanted, Call& call) {
  std::vector<std::size_t> missing;
  call.records.resize(wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    RunRecord& r = call.records[k];
    r.identity = wanted[k];
    r.key = run_key(wanted[k]);
    if (!call.first_of_key.emplace(r.key, k).second) continue;  // asked for twice: simulated once
    if (auto known = store_.find(r.key)) {
      r = std::move(*known);
      r.identity.condition = wanted[k].condition;
    }
    if (is_final(r.state)) ++counts_.num_from_store;
    else missing.push_back(k);
  }
  call.num_done = wanted.size() - missing.size();
  return missing;
}

void RunBroker::count_try(RunRecord& r, const std::string& reason) const {
  ++r.num_tries;
  r.reason = reason;
  r.state = r.num_tries < options_.max_tries ? RunState::failed : RunState::abandoned;
  if (r.state == RunState::abandoned) r.reason += fmt::format(" ({} tries)", r.num_tries);
}

void RunBroker::take_answer(const JobOutcome& outcome, const Job& job, Call& call) const {
  std::vector<RunRecord> answer = read_answer(outcome.answer);
  if (answer.size() != job.size())
    throw std::runtime_error("a worker answered another number of runs than it was asked for");
  for (std::size_t m = 0; m < answer.size(); ++m) {
    RunRecord& r = call.records[job[m]];
    check_answer(answer[m]);
    answer[m].num_tries = r.num_tries;
    answer[m].wall_s = outcome.wall_s / static_cast<double>(answer.size());
    answer[m].key = r.key;
    answer[m].identity = r.identity;
    r = std::move(answer[m]);
    if (r.state == RunState::failed) count_try(r, std::string(r.reason));
    else ++r.num_tries;
  }
}

std::vector<std::string> RunBroker::take_outcome(const JobOutcome& outcome, Call& call) {
  const Job job = call.jobs[outcome.job];  // a copy: the list grows
  counts_.busy_s += outcome.wall_s;
  if (outcome.end == JobEnd::answered) take_answer(outcome, job, call);
  else if (job.size() == 1) count_try(call.records[job.front()], outcome.reason);
  std::vector<std::string> more;
  std::vector<RunRecord> ended;
  for (const std::size_t k : job) {
    const RunRecord& r = call.records[k];
    if (is_final(r.state)) {
      ++counts_.num_simulated, ++call.num_done;
    } else {  // failed, or lost with its job: alone from now on
      ++counts_.num_retries;
      call.jobs.push_back({k});
      more.push_back(request_message(std::span(&r.identity, 1)));
    }
    if (r.state != RunState::candidate) ended.push_back(r);
  }
  store_.add(ended);
  if (options_.progress) options_.progress(call.num_done, call.records.size());
  return more;
}

std::vector<RunRecord> RunBroker::run(std::span<const RunIdentity> wanted) {
  Call call;
  call.jobs = plan(look_up(wanted, call), call.records);
  std::vector<std::string> requests;
  for (const Job& job : call.jobs) {
    std::vector<RunIdentity> members;
    for (const std::size_t k : job) members.push_back(wanted[k]);
    requests.push_back(request_message(members));
  }
  workers_.run(std::move(requests), options_.run_timeout_s, options_.stop,
               [&](const JobOutcome& outcome) { return take_outcome(outcome, call); });
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const std::size_t first = call.first_of_key.at(call.records[k].key);
    if (first != k) call.records[k] = call.records[first];
  }
  return std::move(call.records);
}

}  // namespace tilth
