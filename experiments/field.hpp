// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Named numbers of a config struct: one list serves checking, setting by name and writing back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tilth {

/// One number of a config struct. The name carries the SI unit; the range is closed.
struct Field {
  std::string_view name;
  std::variant<double*, int*, std::uint64_t*, std::vector<double>*> value;
  double lower = 0.0;
  double upper = 0.0;
};

/// "name = x: must be in [lower, upper]" for every field outside its range or not finite.
std::vector<std::string> range_problems(const std::vector<Field>& fields);

/// Field of that name, or nullptr.
const Field* find_field(const std::vector<Field>& fields, std::string_view name);

/// Sets a field from text ("0.05"; lists as "10e3,20e3"). Empty on success, else what was wrong.
std::string set_field(const Field& field, std::string_view text);

/// Sets a field from numbers: a list takes them all, a single number the first. Not checked; see
/// range_problems. @pre values is not empty
void set_numbers(const Field& field, const std::vector<double>& values);

/// Value as shortest text that reads back exactly.
std::string field_text(const Field& field);

}  // namespace tilth
