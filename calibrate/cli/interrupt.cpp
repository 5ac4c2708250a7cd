// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/interrupt.hpp"

#include <csignal>

namespace tilth {
namespace {

// A signal handler can reach nothing but a global; this is the only one in the project.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int signal) {
  interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  static const bool installed = [] {
    std::signal(SIGINT, note_interrupt);
    std::signal(SIGTERM, note_interrupt);
    return true;
  }();
  (void)installed;
  return interrupted;
}

}  // namespace tilth
