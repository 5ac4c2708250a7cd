// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace tilth {

void parallel_for_each_index(std::size_t n, int num_threads,
                             const std::function<void(std::size_t)>& body) {
  if (num_threads <= 1) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  thread_team(num_threads)(n, body);
}

std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)> thread_team(int num_threads) {
  const auto arena = std::make_shared<tbb::task_arena>(std::max(1, num_threads));
  // One index per task: a body is a whole simulation or a thread's share of a step, so balance matters.
  return [arena](std::size_t n, const std::function<void(std::size_t)>& body) {
    arena->execute([&] { tbb::parallel_for(std::size_t{0}, n, body, tbb::simple_partitioner()); });
  };
}

int threads_or_all(int num_threads) {
  return num_threads > 0 ? num_threads
                         : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace tilth
