// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/program.hpp"

int main(int argc, char** argv) { return tilth::run_program(argc, argv); }
