// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of JSON: unknown keys, wrong types and repeated keys are problems, all of them
// listed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tilth {

/// One JSON value. Keys keep the order of the file and are unique (a repeated key is a problem).
struct JsonNode {
  using Array = std::vector<JsonNode>;
  using Object = std::vector<std::pair<std::string, JsonNode>>;
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array,
               Object>
      value;

  const JsonNode* find(std::string_view key) const;  ///< member of an object; null when absent
  std::string type_name()
      const;  ///< "null", "boolean", "integer", "number", "text", "list", "object"
};

/// A parsed file: `root` is null (monostate) when it could not be read; the problem is then listed.
struct JsonDocument {
  std::filesystem::path file;
  JsonNode root;
};

/// @param problems  gets "<file>:<line>: ..." for malformed text, "<file>: ..." for a missing file
JsonDocument read_json(const std::filesystem::path& file, std::vector<std::string>& problems);
JsonDocument parse_json(std::string_view text, const std::filesystem::path& file,
                        std::vector<std::string>& problems);

/// Allowed range of a number; the ends belong to it unless `open`.
struct JsonRange {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool open_lower = false;
  bool open_upper = false;
};

/// Typed reading of one object. Every getter marks its key as known; `finish()` reports the others.
///
///   JsonObjectReader object(document, problems);
///   object.schema("tilth.fit/1");
///   config.seed = object.unsigned_integer("seed", config.seed);   // absent key: the default
///   for (JsonObjectReader& entry : object.objects("parameters")) { ...; entry.finish(); }
///   object.finish();
///   if (!problems.empty()) throw ConfigError(problems);
///
/// A sentence reads "<file>: <pointer> = <found>: must be <allowed>". Getters with a default return
/// it for an absent or wrong value; `required_*` getters also report an absent key and return an
/// empty optional. Nothing throws. Document and problem list must outlive the reader.
class JsonObjectReader {
 public:
  /// The root of a document; a root that is no object is a problem (none if parsing already
  /// failed).
  JsonObjectReader(const JsonDocument& document, std::vector<std::string>& problems);

  bool has(std::string_view key) const;  ///< does not mark the key as known
  bool is_object() const { return object_ != nullptr; }

  void schema(std::string_view expected);  ///< key "schema" must be exactly this word

  double number(std::string_view key, double fallback, const JsonRange& range = {});
  std::optional<double> required_number(std::string_view key, const JsonRange& range = {});
  std::optional<double> optional_number(std::string_view key, const JsonRange& range = {});
  std::int64_t integer(std::string_view key, std::int64_t fallback,
                       std::int64_t lower = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t upper = std::numeric_limits<std::int64_t>::max());
  std::uint64_t unsigned_integer(std::string_view key, std::uint64_t fallback);
  bool flag(std::string_view key, bool fallback);
  std::optional<bool> optional_flag(std::string_view key);
  std::string text(std::string_view key, std::string_view fallback);
  std::optional<std::string> required_text(std::string_view key);  ///< not empty
  /// One of `allowed`; the message names the nearest.
  std::string choice(std::string_view key, std::string_view fallback,
                     std::span<const std::string> allowed);
  std::optional<std::string> required_choice(std::string_view key,
                                             std::span<const std::string> allowed);
  std::vector<double> numbers(std::string_view key,
                              const JsonRange& range = {});  ///< absent: empty
  std::vector<std::string> texts(std::string_view key);      ///< absent: empty
  /// A nested object; absent: empty optional, without a problem.
  std::optional<JsonObjectReader> object(std::string_view key);
  /// A list of objects; absent: empty. Entries of another type are reported and left out.
  std::vector<JsonObjectReader> objects(std::string_view key);
  /// Any value, for callers that read it themselves; null when absent.
  const JsonNode* node(std::string_view key);

  /// "<file>: <pointer>/<key>: <sentence>"; an empty key speaks of the object itself.
  void problem(std::string_view key, std::string_view sentence);
  std::string pointer(std::string_view key = {}) const;  ///< RFC 6901
  void finish();  ///< each key never asked for is a problem, with the nearest known one

 private:
  JsonObjectReader(const std::filesystem::path& file, const JsonNode& node, std::string pointer,
                   std::vector<std::string>& problems);
  const JsonNode* take(std::string_view key);
  void wrong(const std::string& where, const JsonNode& found, std::string_view allowed);
  void missing(std::string_view key, std::string_view allowed);
  std::optional<double> checked_number(const std::string& where, const JsonNode& found,
                                       const JsonRange& range);

  const std::filesystem::path* file_;
  const JsonNode::Object* object_ = nullptr;
  std::string pointer_;
  std::vector<std::string>* problems_;
  std::vector<std::string> known_keys_;
};

}  // namespace tilth
