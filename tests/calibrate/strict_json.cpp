// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/strict_json.hpp"

#include <catch2/catch.hpp>

#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using tilth::soil_test::mentions;

namespace {

std::vector<std::string> problems_of_text(const std::string& text) {
  std::vector<std::string> problems;
  parse_json(text, "f.json", problems);
  return problems;
}

}  // namespace

TEST_CASE("JSON: malformed text is named with its line", "[calibrate][json]") {
  CHECK(mentions(problems_of_text("{\n\"a\": 1,\n\"b\": }\n"), {"f.json:3", "malformed JSON"}));
  CHECK(mentions(problems_of_text(""), {"f.json:1", "malformed JSON"}));
  CHECK(mentions(problems_of_text("{\"a\": 1} x"), {"malformed JSON"}));
  CHECK(mentions(problems_of_text("{\"a\": 1e999}"), {"malformed JSON"}));
  CHECK(mentions(problems_of_text("{\"a\": NaN}"), {"malformed JSON"}));
  CHECK(mentions(problems_of_text("{\"a\": 1, \"a\": 2}"), {"'a' occurs twice"}));
  CHECK(mentions(problems_of_text("null"), {"is null"}));
  CHECK(mentions(problems_of_text(std::string(100000, '[')), {"nested deeper than 64"}));
  CHECK(mentions(problems_of_text("\"\xff\""), {"malformed JSON"}));
}

TEST_CASE("JSON: every wrong value and unknown key is listed with its pointer",
          "[calibrate][json]") {
  std::vector<std::string> problems;
  const JsonDocument document = parse_json(R"({
    "schema": "tilth.fit/2", "seed": -1, "steps": 2.5, "rate": "fast", "share": 1.5, "on": 1,
    "mode": "lineer", "list": [1, "x"], "nested": {"valu": 3}, "items": [{"k": 1}, 7], "a/b": 0
  })",
                                           "f.json", problems);
  REQUIRE(problems.empty());
  JsonObjectReader object(document, problems);
  object.schema("tilth.fit/1");
  CHECK(object.unsigned_integer("seed", 7) == 7);
  CHECK(object.integer("steps", 10) == 10);
  CHECK(object.number("rate", 0.5) == 0.5);
  CHECK_FALSE(object.required_number("share", {.lower = 0.0, .upper = 1.0}));
  CHECK(object.flag("on", true));
  const std::vector<std::string> modes = {"linear", "log"};
  CHECK(object.choice("mode", "log", modes) == "log");
  CHECK(object.numbers("list") == std::vector<double>{1.0});
  auto nested = object.object("nested");
  REQUIRE(nested);
  nested->number("value", 0.0);
  nested->finish();
  CHECK(object.objects("items").size() == 1);
  CHECK_FALSE(object.required_text("title"));
  object.finish();
  CHECK(mentions(problems, {"/schema = \"tilth.fit/2\": must be \"tilth.fit/1\""}));
  CHECK(mentions(problems, {"/seed = -1: must be an integer >= 0"}));
  CHECK(mentions(problems, {"/steps = 2.5: must be an integer"}));
  CHECK(mentions(problems, {"/rate = \"fast\": must be a number"}));
  CHECK(mentions(problems, {"/share = 1.5: must be a number in [0, 1]"}));
  CHECK(mentions(problems, {"/on = 1: must be true or false"}));
  CHECK(mentions(problems, {"/mode: unknown word 'lineer'", "did you mean linear?"}));
  CHECK(mentions(problems, {"/list/1 = \"x\": must be a number"}));
  CHECK(mentions(problems, {"/nested/valu: unknown key 'valu'", "did you mean value?"}));
  CHECK(mentions(problems, {"/items/1 = 7: must be an object"}));
  CHECK(mentions(problems, {"\"title\" is missing"}));
  CHECK(mentions(problems, {"/a~1b: unknown key 'a/b'"}));
  CHECK(problems.size() == 12);
}

TEST_CASE("JSON: absent keys take the default in silence", "[calibrate][json]") {
  std::vector<std::string> problems;
  const JsonDocument document = parse_json(R"({"big": 18446744073709551615})", "f.json", problems);
  JsonObjectReader object(document, problems);
  CHECK(object.number("rate", 0.5) == 0.5);
  CHECK(object.text("title", "none") == "none");
  CHECK(object.unsigned_integer("big", 0) == 18446744073709551615u);
  CHECK_FALSE(object.object("nested"));
  object.finish();
  CHECK(problems.empty());
}

TEST_CASE("JSON: a root that is no object is one problem, not many", "[calibrate][json]") {
  std::vector<std::string> problems;
  const JsonDocument document = parse_json("[1]", "f.json", problems);
  JsonObjectReader object(document, problems);
  object.schema("x/1");
  object.required_text("id");
  object.finish();
  CHECK(problems == std::vector<std::string>{"f.json: /: is a list: must be an object {...}"});
}
