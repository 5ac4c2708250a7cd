// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// SHA-256 of a text.
#pragma once

#include <string>
#include <string_view>

namespace tilth {

/// 64 hexadecimal digits. @throws std::runtime_error if OpenSSL has no SHA-256
std::string sha256(std::string_view text);

}  // namespace tilth
