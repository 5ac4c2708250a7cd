// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/worker_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <stdexcept>

namespace tilth {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int tick_ms = 100;
constexpr int max_early_deaths = 3;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string with_last_words(const std::string& sentence, const std::string& words) {
  return words.empty() ? sentence : fmt::format("{}; it said: {}", sentence, words);
}

}  // namespace

/// Where a worker sits, and the job it has.
struct WorkerPool::Seat {
  std::optional<WorkerProcess> worker;
  bool ready = false;
  bool busy = false;
  std::size_t job = 0;
  Clock::time_point start;
};

/// One call of run().
struct WorkerPool::Round {
  std::vector<std::string> requests;
  std::deque<std::size_t> waiting;
  double limit_s;
  const OnEnd& on_end;
};

WorkerPool::WorkerPool(std::vector<std::string> command, int num_workers)
    : command_(std::move(command)), num_workers_(std::max(1, num_workers)) {
  ::signal(SIGPIPE, SIG_IGN);  // a dead worker is an outcome, not the end of the program
}

void WorkerPool::start_next(Round& round, Seat& seat) {
  if (round.waiting.empty()) return;
  if (!seat.worker) {
    seat.worker.emplace(command_);
    seat.ready = false;
  }
  seat.busy = true;
  seat.job = round.waiting.front();
  seat.start = Clock::now();
  round.waiting.pop_front();
  seat.worker->send(round.requests[seat.job]);  // a dead worker shows when it is read
}

void WorkerPool::finish(Round& round, Seat& seat, JobOutcome outcome) {
  seat.busy = false;
  outcome.job = seat.job;
  outcome.wall_s = seconds_since(seat.start);
  if (outcome.end != JobEnd::answered) seat.worker.reset();
  for (std::string& more : round.on_end(outcome)) {
    round.waiting.push_back(round.requests.size());
    round.requests.push_back(std::move(more));
  }
}

void WorkerPool::lost_before_ready(Round& round, Seat& seat, const std::string& reason) {
  if (++num_early_deaths_ >= max_early_deaths)
    throw std::runtime_error(fmt::format("{} workers in a row died before they were ready: {}",
                                         max_early_deaths, reason));
  seat.busy = false;
  seat.worker.reset();
  round.waiting.push_front(seat.job);
}

void WorkerPool::look_after(Round& round, Seat& seat) {
  seat.worker->read_errors();
  const bool open = seat.worker->read_answer();
  std::optional<std::string> line = seat.worker->next_line();
  if (line && !seat.ready) {
    seat.ready = true;
    num_early_deaths_ = 0;
    line = seat.worker->next_line();
  }
  if (line) return finish(round, seat, {0, JobEnd::answered, std::move(*line), "", 0.0});
  if (!open) {
    const std::string how = seat.worker->end();
    const std::string reason =
        with_last_words("the worker died (" + how + ")", seat.worker->last_words());
    if (!seat.ready) return lost_before_ready(round, seat, reason);
    return finish(round, seat, {0, JobEnd::crashed, "", reason, 0.0});
  }
  if (seconds_since(seat.start) <= round.limit_s) return;
  finish(round, seat,
         {0, JobEnd::overdue, "",
          fmt::format("not finished after {:.4g} s (--run-timeout); its worker was killed",
                      round.limit_s),
          0.0});
}

void WorkerPool::run(std::vector<std::string> requests, double limit_s,
                     const std::function<StopWish()>& stop, const OnEnd& on_end) {
  Round round{std::move(requests), {}, limit_s, on_end};
  for (std::size_t k = 0; k < round.requests.size(); ++k) round.waiting.push_back(k);
  std::vector<Seat> seats(static_cast<std::size_t>(num_workers_));
  for (Seat& seat : seats) {
    if (idle_.empty()) break;
    seat.worker.emplace(std::move(idle_.back()));
    seat.ready = true;
    idle_.pop_back();
  }
  for (;;) {
    const StopWish wish = stop ? stop() : StopWish::none;
    if (wish == StopWish::at_once) return;  // the seats kill their workers
    for (Seat& seat : seats)
      if (!seat.busy && wish == StopWish::none) start_next(round, seat);
    std::vector<pollfd> watched;
    for (Seat& seat : seats)
      if (seat.busy) watched.push_back({seat.worker->answer_fd(), POLLIN, 0});
    if (watched.empty()) break;
    ::poll(watched.data(), watched.size(), tick_ms);
    for (Seat& seat : seats)
      if (seat.busy) look_after(round, seat);
  }
  for (Seat& seat : seats)
    if (seat.worker) idle_.push_back(std::move(*seat.worker));
}

}  // namespace tilth
