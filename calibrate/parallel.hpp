// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// A parallel loop over independent indices; the only door to the thread library.
#pragma once

#include <cstddef>
#include <functional>

namespace tilth {

/// Calls body(i) once for every i in [0, n), on at most num_threads threads.
///
/// The order of calls is unspecified: the body writes to slot i and reads nothing another index
/// writes, then results do not depend on num_threads. num_threads <= 1 runs on the calling thread,
/// in order.
/// @throws the first exception a body throws; indices not yet started may then be left out
void parallel_for_each_index(std::size_t n, int num_threads,
                             const std::function<void(std::size_t)>& body);

/// The same loop for bodies of a millisecond or less that are called over and over: its threads are kept.
/// @thread_safety the function may be copied; calls of one team may not overlap
std::function<void(std::size_t n, const std::function<void(std::size_t)>& body)> thread_team(int num_threads);

/// The number itself, or for 0 what the machine has, at least 1.
int threads_or_all(int num_threads);

}  // namespace tilth
