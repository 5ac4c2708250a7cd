// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Time limits as Slurm writes them.
#pragma once

#include <optional>
#include <string>

namespace tilth {

/// "30" (minutes), "30:15", "1:30:00", "2-12" (days-hours), "2-12:30", "2-12:30:00" as seconds; empty
/// if the text is none of these or zero.
/// @source sbatch(1), option --time
std::optional<double> seconds_of_walltime(const std::string& text);

}  // namespace tilth
