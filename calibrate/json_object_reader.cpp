// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Typed, strict access to parsed JSON; the parser itself is in strict_json.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calibrate/nearest_name.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {
namespace {

std::optional<double> as_number(const JsonNode& node) {
  if (const auto* value = std::get_if<double>(&node.value)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&node.value))
    return static_cast<double>(*value);
  if (const auto* value = std::get_if<std::uint64_t>(&node.value))
    return static_cast<double>(*value);
  return std::nullopt;
}

std::string shown(const JsonNode& node) {
  if (const auto* value = std::get_if<bool>(&node.value)) return *value ? "true" : "false";
  if (const auto* value = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *value);
  if (const auto* value = std::get_if<std::uint64_t>(&node.value)) return fmt::format("{}", *value);
  if (const auto* value = std::get_if<double>(&node.value)) return fmt::format("{}", *value);
  if (const auto* value = std::get_if<std::string>(&node.value)) {
    return fmt::format("\"{}\"", value->substr(0, 60));
  }
  return "a " + node.type_name();
}

std::string allowed_text(const JsonRange& range) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (range.lower == -infinity && range.upper == infinity) return "a number";
  if (range.upper == infinity) {
    return fmt::format("a number {} {}", range.open_lower ? ">" : ">=", range.lower);
  }
  if (range.lower == -infinity) {
    return fmt::format("a number {} {}", range.open_upper ? "<" : "<=", range.upper);
  }
  return fmt::format("a number in {}{}, {}{}", range.open_lower ? '(' : '[', range.lower,
                     range.upper, range.open_upper ? ')' : ']');
}

bool inside(double number, const JsonRange& range) {
  const bool above = range.open_lower ? number > range.lower : number >= range.lower;
  const bool below = range.open_upper ? number < range.upper : number <= range.upper;
  return above && below;
}

}  // namespace

JsonObjectReader::JsonObjectReader(const JsonDocument& document, std::vector<std::string>& problems)
    : JsonObjectReader(document.file, document.root, "", problems) {
  const bool parsed = !std::holds_alternative<std::monostate>(document.root.value);
  if (parsed && object_ == nullptr) {
    problem("", fmt::format("is a {}: must be an object {{...}}", document.root.type_name()));
  }
}

JsonObjectReader::JsonObjectReader(const std::filesystem::path& file, const JsonNode& node,
                                   std::string pointer, std::vector<std::string>& problems)
    : file_(&file),
      object_(std::get_if<JsonNode::Object>(&node.value)),
      pointer_(std::move(pointer)),
      problems_(&problems) {}

bool JsonObjectReader::has(std::string_view key) const {
  if (object_ == nullptr) return false;
  return std::any_of(object_->begin(), object_->end(),
                     [key](const auto& member) { return member.first == key; });
}

const JsonNode* JsonObjectReader::take(std::string_view key) {
  known_keys_.emplace_back(key);
  if (object_ == nullptr) return nullptr;
  for (const auto& [name, member] : *object_) {
    if (name == key) return &member;
  }
  return nullptr;
}

std::string JsonObjectReader::pointer(std::string_view key) const {
  if (key.empty()) return pointer_.empty() ? "/" : pointer_;
  std::string escaped;
  for (const char letter : key) {
    if (letter == '~')
      escaped += "~0";
    else if (letter == '/')
      escaped += "~1";
    else
      escaped += letter;
  }
  return pointer_ + "/" + escaped;
}

void JsonObjectReader::problem(std::string_view key, std::string_view sentence) {
  problems_->push_back(fmt::format("{}: {}: {}", file_->string(), pointer(key), sentence));
}

void JsonObjectReader::wrong(const std::string& where, const JsonNode& found,
                             std::string_view allowed) {
  problems_->push_back(
      fmt::format("{}: {} = {}: must be {}", file_->string(), where, shown(found), allowed));
}

void JsonObjectReader::missing(std::string_view key, std::string_view allowed) {
  if (object_ == nullptr) return;
  problem("", fmt::format("the key \"{}\" is missing: must be {}", key, allowed));
}

std::optional<double> JsonObjectReader::checked_number(const std::string& where,
                                                       const JsonNode& found,
                                                       const JsonRange& range) {
  const auto number = as_number(found);
  if (number && inside(*number, range)) return number;
  wrong(where, found, allowed_text(range));
  return std::nullopt;
}

void JsonObjectReader::schema(std::string_view expected) {
  const JsonNode* found = take("schema");
  if (found == nullptr) return missing("schema", fmt::format("\"{}\"", expected));
  const auto* word = std::get_if<std::string>(&found->value);
  if (word == nullptr || *word != expected)
    wrong(pointer("schema"), *found, fmt::format("\"{}\"", expected));
}

double JsonObjectReader::number(std::string_view key, double fallback, const JsonRange& range) {
  return optional_number(key, range).value_or(fallback);
}

std::optional<double> JsonObjectReader::optional_number(std::string_view key,
                                                        const JsonRange& range) {
  const JsonNode* found = take(key);
  return found == nullptr ? std::nullopt : checked_number(pointer(key), *found, range);
}

std::optional<double> JsonObjectReader::required_number(std::string_view key,
                                                        const JsonRange& range) {
  const JsonNode* found = take(key);
  if (found != nullptr) return checked_number(pointer(key), *found, range);
  missing(key, allowed_text(range));
  return std::nullopt;
}

std::int64_t JsonObjectReader::integer(std::string_view key, std::int64_t fallback,
                                       std::int64_t lower, std::int64_t upper) {
  const JsonNode* found = take(key);
  if (found == nullptr) return fallback;
  std::optional<std::int64_t> value;
  if (const auto* signed_value = std::get_if<std::int64_t>(&found->value)) value = *signed_value;
  const auto* large = std::get_if<std::uint64_t>(&found->value);
  if (large != nullptr &&
      *large <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    value = static_cast<std::int64_t>(*large);
  }
  if (value && *value >= lower && *value <= upper) return *value;
  wrong(pointer(key), *found, fmt::format("an integer in [{}, {}]", lower, upper));
  return fallback;
}

std::uint64_t JsonObjectReader::unsigned_integer(std::string_view key, std::uint64_t fallback) {
  const JsonNode* found = take(key);
  if (found == nullptr) return fallback;
  if (const auto* value = std::get_if<std::uint64_t>(&found->value)) return *value;
  wrong(pointer(key), *found, "an integer >= 0");
  return fallback;
}

std::optional<bool> JsonObjectReader::optional_flag(std::string_view key) {
  const JsonNode* found = take(key);
  if (found == nullptr) return std::nullopt;
  if (const auto* value = std::get_if<bool>(&found->value)) return *value;
  wrong(pointer(key), *found, "true or false");
  return std::nullopt;
}

bool JsonObjectReader::flag(std::string_view key, bool fallback) {
  return optional_flag(key).value_or(fallback);
}

std::string JsonObjectReader::text(std::string_view key, std::string_view fallback) {
  const JsonNode* found = take(key);
  if (found == nullptr) return std::string(fallback);
  if (const auto* value = std::get_if<std::string>(&found->value)) return *value;
  wrong(pointer(key), *found, "a text in quotes");
  return std::string(fallback);
}

std::optional<std::string> JsonObjectReader::required_text(std::string_view key) {
  const JsonNode* found = take(key);
  if (found == nullptr) {
    missing(key, "a text in quotes");
    return std::nullopt;
  }
  const auto* value = std::get_if<std::string>(&found->value);
  if (value != nullptr && !value->empty()) return *value;
  wrong(pointer(key), *found, "a text in quotes, not empty");
  return std::nullopt;
}

std::string JsonObjectReader::choice(std::string_view key, std::string_view fallback,
                                     std::span<const std::string> allowed) {
  if (!has(key)) {
    known_keys_.emplace_back(key);
    return std::string(fallback);
  }
  return required_choice(key, allowed).value_or(std::string(fallback));
}

std::optional<std::string> JsonObjectReader::required_choice(std::string_view key,
                                                             std::span<const std::string> allowed) {
  const std::string list = fmt::format("one of {}", fmt::join(allowed, ", "));
  const JsonNode* found = take(key);
  if (found == nullptr) {
    missing(key, list);
    return std::nullopt;
  }
  const auto* word = std::get_if<std::string>(&found->value);
  if (word == nullptr) {
    wrong(pointer(key), *found, list);
    return std::nullopt;
  }
  if (std::find(allowed.begin(), allowed.end(), *word) != allowed.end()) return *word;
  problem(key, unknown_name_sentence("word", *word, allowed));
  return std::nullopt;
}

std::vector<double> JsonObjectReader::numbers(std::string_view key, const JsonRange& range) {
  std::vector<double> result;
  const JsonNode* found = take(key);
  if (found == nullptr) return result;
  const auto* list = std::get_if<JsonNode::Array>(&found->value);
  if (list == nullptr) {
    wrong(pointer(key), *found, "a list of numbers");
    return result;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto number = checked_number(pointer(key) + fmt::format("/{}", i), (*list)[i], range);
    if (number) result.push_back(*number);
  }
  return result;
}

std::vector<std::string> JsonObjectReader::texts(std::string_view key) {
  std::vector<std::string> result;
  const JsonNode* found = take(key);
  if (found == nullptr) return result;
  const auto* list = std::get_if<JsonNode::Array>(&found->value);
  if (list == nullptr) {
    wrong(pointer(key), *found, "a list of texts");
    return result;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto* word = std::get_if<std::string>(&(*list)[i].value);
    if (word != nullptr)
      result.push_back(*word);
    else
      wrong(pointer(key) + fmt::format("/{}", i), (*list)[i], "a text in quotes");
  }
  return result;
}

std::optional<JsonObjectReader> JsonObjectReader::object(std::string_view key) {
  const JsonNode* found = take(key);
  if (found == nullptr) return std::nullopt;
  if (!std::holds_alternative<JsonNode::Object>(found->value)) {
    wrong(pointer(key), *found, "an object {...}");
    return std::nullopt;
  }
  return JsonObjectReader(*file_, *found, pointer(key), *problems_);
}

std::vector<JsonObjectReader> JsonObjectReader::objects(std::string_view key) {
  std::vector<JsonObjectReader> result;
  const JsonNode* found = take(key);
  if (found == nullptr) return result;
  const auto* list = std::get_if<JsonNode::Array>(&found->value);
  if (list == nullptr) {
    wrong(pointer(key), *found, "a list of objects");
    return result;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string entry = fmt::format("{}/{}", pointer(key), i);
    if (std::holds_alternative<JsonNode::Object>((*list)[i].value)) {
      result.push_back(JsonObjectReader(*file_, (*list)[i], entry, *problems_));
    } else {
      wrong(entry, (*list)[i], "an object {...}");
    }
  }
  return result;
}

const JsonNode* JsonObjectReader::node(std::string_view key) { return take(key); }

void JsonObjectReader::finish() {
  if (object_ == nullptr) return;
  for (const auto& [name, member] : *object_) {
    const bool known = std::find(known_keys_.begin(), known_keys_.end(), name) != known_keys_.end();
    if (!known) problem(name, unknown_name_sentence("key", name, known_keys_));
  }
}

}  // namespace tilth
