// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and SIGTERM end a job cleanly: the first sets a flag, the second kills.
#pragma once

#include <atomic>

namespace tilth {

/// The flag that SIGINT and SIGTERM set. Installs the handlers on first use.
const std::atomic<bool>& interrupt_flag();

}  // namespace tilth
