// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/strict_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tilth {
namespace {

constexpr std::size_t deepest_nesting = 64;  // so that no file can exhaust the stack

std::size_t line_of(std::string_view text, std::size_t position) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(position, text.size()));
  return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
}

/// Receives the parser's events and builds the tree of JsonNode.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, const std::filesystem::path& file,
              std::vector<std::string>& problems)
      : text_(text), file_(file), problems_(problems) {}

  JsonNode root;

  bool null() override { return add({}); }
  bool boolean(bool value) override { return add({value}); }
  bool number_integer(number_integer_t value) override { return add({std::int64_t{value}}); }
  bool number_unsigned(number_unsigned_t value) override { return add({std::uint64_t{value}}); }
  bool number_float(number_float_t value, const string_t&) override { return add({value}); }
  bool string(string_t& value) override { return add({std::move(value)}); }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open({JsonNode::Object{}}); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open({JsonNode::Array{}}); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (open_.back()->find(name) != nullptr) {
      problems_.push_back(
          fmt::format("{}: the key '{}' occurs twice in one object", file_.string(), name));
    }
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& error) override {
    std::string what = error.what();
    const auto last_colon = what.rfind("; expected");
    const std::string expected = last_colon == std::string::npos ? "" : what.substr(last_colon + 2);
    problems_.push_back(fmt::format("{}:{}: malformed JSON near '{}'{}{}", file_.string(),
                                    line_of(text_, position), token, expected.empty() ? "" : ": ",
                                    expected));
    return false;
  }

 private:
  JsonNode* place(JsonNode node) {
    if (open_.empty()) {
      root = std::move(node);
      return &root;
    }
    if (auto* list = std::get_if<JsonNode::Array>(&open_.back()->value)) {
      return &list->emplace_back(std::move(node));
    }
    auto& members = std::get<JsonNode::Object>(open_.back()->value);
    return &members.emplace_back(std::move(key_), std::move(node)).second;
  }

  bool add(JsonNode node) {
    place(std::move(node));
    return true;
  }

  bool open(JsonNode node) {
    if (open_.size() >= deepest_nesting) {
      problems_.push_back(
          fmt::format("{}: nested deeper than {} levels", file_.string(), deepest_nesting));
      return false;
    }
    open_.push_back(place(std::move(node)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  std::vector<std::string>& problems_;
  std::vector<JsonNode*> open_;  // a parent's list grows only after its last child is closed
  std::string key_;
};

}  // namespace

const JsonNode* JsonNode::find(std::string_view key) const {
  const auto* members = std::get_if<Object>(&value);
  if (members == nullptr) return nullptr;
  for (const auto& [name, member] : *members) {
    if (name == key) return &member;
  }
  return nullptr;
}

std::string JsonNode::type_name() const {
  constexpr const char* names[] = {"null",   "boolean", "integer", "integer",
                                   "number", "text",    "list",    "object"};
  return names[value.index()];
}

JsonDocument parse_json(std::string_view text, const std::filesystem::path& file,
                        std::vector<std::string>& problems) {
  JsonDocument document;
  document.file = file;
  const std::size_t before = problems.size();
  TreeBuilder builder(text, file, problems);
  const bool complete = nlohmann::json::sax_parse(text, &builder);
  if (!complete && problems.size() == before) {
    problems.push_back(fmt::format("{}: malformed JSON", file.string()));
  }
  if (complete) document.root = std::move(builder.root);
  if (complete && std::holds_alternative<std::monostate>(document.root.value)) {
    problems.push_back(fmt::format("{}: is null: must be an object {{...}}", file.string()));
  }
  return document;
}

JsonDocument read_json(const std::filesystem::path& file, std::vector<std::string>& problems) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  const bool opened = !std::filesystem::is_directory(file) && stream.is_open();
  if (opened && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!opened || stream.bad()) {
    problems.push_back(fmt::format("{}: the file is missing or cannot be read", file.string()));
    return {file, {}};
  }
  return parse_json(text.str(), file, problems);
}

}  // namespace tilth
