// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/csv_table.hpp"

#include <catch2/catch.hpp>

#include "calibrate/nearest_name.hpp"
#include "tests/calibrate/soil_folder.hpp"

using namespace tilth;
using tilth::soil_test::mentions;

namespace {

CsvTable parsed(const std::string& text, std::vector<std::string>& problems) {
  return parse_csv(text, "t.csv", {{"a", "b"}, {"c"}}, problems);
}

}  // namespace

TEST_CASE("CSV: quotes, line breaks in quotes, CRLF and a byte-order mark are read",
          "[calibrate][csv]") {
  std::vector<std::string> problems;
  const CsvTable table = parsed(
      "\xEF\xBB\xBF"
      "a,b\r\n1,\"x, \"\"y\"\"\nz\"\r\n\r\n 2 , w \r\n3,last",
      problems);
  CHECK(problems == std::vector<std::string>{});
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0].fields == std::vector<std::string>{"1", "x, \"y\"\nz"});
  CHECK(table.rows[1].fields == std::vector<std::string>{"2", "w"});
  CHECK(table.rows[2].fields == std::vector<std::string>{"3", "last"});
  // the quoted line break counts: record 2 begins on line 2, record 3 on line 5
  CHECK(table.rows[0].line == 2);
  CHECK(table.rows[1].line == 5);
  CHECK(table.rows[2].line == 6);
}

TEST_CASE("CSV: what is wrong with the shape is said with its line", "[calibrate][csv]") {
  std::vector<std::string> problems;
  parsed("a,b\n1\n1,2,3\n\"open,2\n", problems);
  CHECK(mentions(problems, {"t.csv:2: 1 fields, the header has 2 columns"}));
  CHECK(mentions(problems, {"t.csv:3: 3 fields"}));
  CHECK(mentions(problems, {"t.csv:4: a quote", "never closed"}));

  for (const std::string text : {"", "\n\n", "\xEF\xBB\xBF"}) {
    problems.clear();
    parsed(text, problems);
    CHECK(mentions(problems, {"t.csv:1: empty"}));
  }
  problems.clear();
  parsed("a;b\n1;2\n", problems);
  CHECK(mentions(problems, {"separate them by ','"}));
  problems.clear();
  parsed("a,a,bb\n", problems);
  CHECK(mentions(problems, {"column 'a' occurs twice"}));
  CHECK(mentions(problems, {"column 'b' is missing"}));
  CHECK(mentions(problems, {"unknown column 'bb'"}));
  problems.clear();
  read_csv(soil_test::data_root(), {{"a"}, {}}, problems);  // a folder
  CHECK(problems.size() == 1);
}

TEST_CASE("CSV: only finite numbers that fill the field are numbers", "[calibrate][csv]") {
  CHECK(parse_finite_number("1e-3") == 1e-3);
  CHECK(parse_finite_number("+2.5") == 2.5);
  CHECK(parse_finite_number("-0") == 0.0);
  for (const char* word : {"", "+", "nan", "NaN", "inf", "-infinity", "1e999", "1,5", "1 2", "0x10",
                           "1.5kPa", "--1", "+-1"}) {
    CAPTURE(word);
    CHECK_FALSE(parse_finite_number(word));
  }
}

TEST_CASE("CSV: a list keeps its numbers and reports the others", "[calibrate][csv]") {
  std::vector<std::string> problems;
  const CsvTable table = parsed("a,b\n1; 2 ;x;,1\n", problems);
  CsvRowReader row(table, table.rows.at(0), problems);
  CHECK(row.optional_numbers("a") == std::vector<double>{1.0, 2.0});
  CHECK(problems == std::vector<std::string>{"t.csv:2: a = 'x' is not a finite number"});
}

TEST_CASE("Names: the nearest one is suggested, a far one is not", "[calibrate][csv]") {
  const std::vector<std::string> known = {"coarse_sand", "loamy_sand", "sandy_loam"};
  CHECK(nearest_name("loamysand", known) == "loamy_sand");
  CHECK(nearest_name("Sandy-Loam", known) == "sandy_loam");
  CHECK(nearest_name("heavy clay", known).empty());
  CHECK(nearest_name("", known).empty());
  CHECK(nearest_name("x", {}).empty());
  CHECK(edit_distance("abcd", "abdc") == 1);  // a swap is one mistake
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);
}
