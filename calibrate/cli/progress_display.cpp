// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/progress_display.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace tilth {

std::string clock_text(double seconds) {
  const auto s = static_cast<long>(std::max(seconds, 0.0) + 0.5);
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string progress_line(const Progress& p, double elapsed_s) {
  const std::size_t expected = std::max(p.num_expected, p.num_done);
  std::string line = fmt::format("{}: {} of about {} simulations, {} elapsed", p.stage, p.num_done,
                                 expected, clock_text(elapsed_s));
  if (p.num_done > 0)
    line += fmt::format(", about {} left",
                        clock_text(elapsed_s / static_cast<double>(p.num_done) *
                                   static_cast<double>(expected - p.num_done)));
  return line;
}

ProgressDisplay::ProgressDisplay(bool terminal, std::function<void(const std::string&)> log)
    : terminal_(terminal), log_(std::move(log)), start_(std::chrono::steady_clock::now()) {}

ProgressDisplay::~ProgressDisplay() { finish(); }

double ProgressDisplay::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressDisplay::show(const Progress& p) {
  const double now_s = seconds();
  const std::string line = progress_line(p, now_s);
  if (terminal_) {
    const double share = static_cast<double>(p.num_done) /
                         static_cast<double>(std::max<std::size_t>(
                             std::max(p.num_expected, p.num_done), 1));
    const auto filled = static_cast<std::size_t>(share * 24);
    std::fprintf(stderr, "\r\033[K[%s%s] %s", std::string(filled, '#').c_str(),
                 std::string(24 - filled, '.').c_str(), line.c_str());
    std::fflush(stderr);
    line_open_ = true;
  }
  if (p.stage == last_stage_ && now_s - last_line_s_ < 10) return;
  last_stage_ = p.stage;
  last_line_s_ = now_s;
  log_(line);
}

void ProgressDisplay::finish() {
  if (line_open_) std::fputs("\r\033[K", stderr);
  line_open_ = false;
}

}  // namespace tilth
