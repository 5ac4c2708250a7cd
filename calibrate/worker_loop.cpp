// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/worker_loop.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "calibrate/fault_injection.hpp"
#include "calibrate/run_message.hpp"

namespace tilth {
namespace {

std::optional<std::string> read_line() {
  std::string line;
  for (int c = std::getc(stdin); c != EOF; c = std::getc(stdin)) {
    if (c == '\n') return line;
    line += static_cast<char>(c);
  }
  return std::nullopt;
}

void write_line(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

std::string host_name() {
  char name[256] = "";
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace

int run_worker(const MemberSimulator& simulate) {
  const pid_t parent = ::getppid();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) return 1;  // it died before the line above
  std::signal(SIGINT, SIG_IGN);
  const std::optional<Faults> faults = faults_on_order();
  const std::string host = host_name();
  write_line("ready");
  while (const auto line = read_line()) {
    const std::vector<RunIdentity> members = read_request(*line);
    std::vector<RunRecord> records;
    try {
      records = simulate(members);
    } catch (const std::exception& e) {  // the same each time: not a crash
      RunRecord refused;
      refused.state = RunState::abandoned;
      refused.reason = e.what();
      records.assign(members.size(), refused);
    }
    for (std::size_t m = 0; m < records.size(); ++m) {
      records[m].identity = members[m];
      records[m].key = run_key(members[m]);
      records[m].host = host;
      if (faults) suffer(faults->next(records[m].key), records[m]);
    }
    write_line(answer_message(records));
  }
  return 0;
}

}  // namespace tilth
