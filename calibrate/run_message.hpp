// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What a program and its workers say to each other: one JSON text per line, nothing else needed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibrate/run_record.hpp"

namespace tilth {

/// Members of one test setup: their identities differ in the material only.
std::string request_message(std::span<const RunIdentity> members);
/// @throws std::runtime_error if the text is no request
std::vector<RunIdentity> read_request(const std::string& message);

/// Results in the order of the request; each holds its whole identity, so that a message of another
/// machine can be kept in a file and added to any store. Numbers read back exactly; a number that is
/// not finite becomes NaN.
std::string answer_message(std::span<const RunRecord> records);
/// @throws std::runtime_error if the text is no answer
std::vector<RunRecord> read_answer(const std::string& message);

}  // namespace tilth
