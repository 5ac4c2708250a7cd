// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// SHA-256 of input files, so that a result can name what it was made from.
#pragma once

#include <filesystem>
#include <string>

namespace tilth {

/// Lower-case hexadecimal. @throws std::runtime_error with the path if it cannot be read
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace tilth
