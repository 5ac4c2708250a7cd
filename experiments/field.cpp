// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

namespace tilth {
namespace {

template <typename T>
bool parse(std::string_view text, T& value) {
  const char* end = text.data() + text.size();
  T read{};
  const auto [stop, error] = std::from_chars(text.data(), end, read);
  if (error != std::errc() || stop != end) return false;
  value = read;
  return true;
}

bool parse(std::string_view text, std::vector<double>& values) {
  std::vector<double> read;
  while (true) {
    const std::size_t comma = text.find(',');
    double value = 0.0;
    if (!parse(text.substr(0, comma), value)) return false;
    read.push_back(value);
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  values = std::move(read);
  return true;
}

std::vector<double> numbers(const Field& field) {
  return std::visit(
      [](const auto* v) -> std::vector<double> {
        if constexpr (std::is_same_v<std::decay_t<decltype(*v)>, std::vector<double>>) return *v;
        else return {static_cast<double>(*v)};
      },
      field.value);
}

}  // namespace

std::vector<std::string> range_problems(const std::vector<Field>& fields) {
  std::vector<std::string> found;
  for (const Field& f : fields)
    for (const double v : numbers(f))
      if (!(v >= f.lower && v <= f.upper))
        found.push_back(fmt::format("{} = {}: must be in [{}, {}]", f.name, v, f.lower, f.upper));
  return found;
}

const Field* find_field(const std::vector<Field>& fields, std::string_view name) {
  for (const Field& f : fields)
    if (f.name == name) return &f;
  return nullptr;
}

std::string set_field(const Field& field, std::string_view text) {
  const bool ok = std::visit([&](auto* v) { return parse(text, *v); }, field.value);
  if (!ok) return fmt::format("{} = '{}': is not a number this field can hold", field.name, text);
  const auto found = range_problems({field});
  return found.empty() ? std::string() : found.front();
}

void set_numbers(const Field& field, const std::vector<double>& values) {
  std::visit(
      [&values](auto* v) {
        using T = std::decay_t<decltype(*v)>;
        if constexpr (std::is_same_v<T, std::vector<double>>) *v = values;
        else *v = static_cast<T>(values.front());
      },
      field.value);
}

std::string field_text(const Field& field) {
  return std::visit(
      [](const auto* v) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(*v)>, std::vector<double>>)
          return fmt::format("{}", fmt::join(*v, ","));
        else return fmt::format("{}", *v);
      },
      field.value);
}

}  // namespace tilth
