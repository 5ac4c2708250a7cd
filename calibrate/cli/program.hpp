// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The program without its main(): testable with an argument list.
#pragma once

namespace tilth {

/// Parses the command line, runs the command and maps every error to an exit code (exit_code.hpp).
int run_program(int argc, const char* const* argv);

}  // namespace tilth
