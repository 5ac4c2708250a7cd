// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/export_template.hpp"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

namespace tilth {
namespace {

bool belongs_to_name(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

std::string fill_template(std::string_view text, const TemplateValues& values) {
  std::string out;
  std::set<std::string> used;
  while (!text.empty()) {
    const std::size_t at = text.find('@');
    out += text.substr(0, at);
    if (at == std::string_view::npos) break;
    std::size_t end = at + 1;
    while (end < text.size() && belongs_to_name(text[end])) ++end;
    if (end == at + 1 || end == text.size() || text[end] != '@')
      throw std::logic_error("deck template: a lone @");
    const std::string name(text.substr(at + 1, end - at - 1));
    const auto value = values.find(name);
    if (value == values.end()) throw std::logic_error("deck template: no value for " + name);
    out += value->second;
    used.insert(name);
    text.remove_prefix(end + 1);
  }
  for (const auto& [name, value] : values)
    if (!used.contains(name)) throw std::logic_error("deck template: no place for " + name);
  return out;
}

std::string number_text(double value) { return fmt::format("{}", value); }

std::string comment_lines(std::string_view sign, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    if (!text.empty()) text += '\n';
    text += sign;
    if (!line.empty()) text += " ";
    for (const char c : line) text += c == '\n' || c == '\r' ? ' ' : c;
  }
  return text;
}

}  // namespace tilth
