// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_record.hpp"

#include "calibrate/sha256.hpp"

namespace tilth {

std::string_view to_string(RunState state) {
  switch (state) {
    case RunState::candidate: return "CANDIDATE";
    case RunState::running: return "RUNNING";
    case RunState::overdue: return "OVERDUE";
    case RunState::completed: return "COMPLETED";
    case RunState::failed: return "FAILED";
    case RunState::abandoned: return "ABANDONED";
  }
  return "";
}

std::string run_key(const RunIdentity& identity) {
  // lengths before the texts: no two identities run into one
  std::string text;
  for (const std::string* part : {&identity.solver, &identity.test, &identity.setup, &identity.material})
    text += std::to_string(part->size()) + ":" + *part;
  return sha256(text);
}

}  // namespace tilth
