// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/field.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <set>

#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using Catch::Matchers::Contains;

namespace {

struct Numbers {
  double length_m = 0.5;
  int count = 3;
  std::uint64_t seed = 1;
  std::vector<double> stress_Pa = {1e3, 2e3};
};

std::vector<Field> fields(Numbers& n) {
  return {{"length_m", &n.length_m, 0, 1},
          {"count", &n.count, 1, 10},
          {"seed", &n.seed, 0, 9e15},
          {"stress_Pa", &n.stress_Pa, 1, 1e6}};
}

std::string set(Numbers& n, std::string_view name, std::string_view text) {
  const std::vector<Field> all = fields(n);
  const Field* field = find_field(all, name);
  REQUIRE(field != nullptr);
  return set_field(*field, text);
}

}  // namespace

TEST_CASE("Fields: text sets numbers and lists, and field_text reads back exactly",
          "[experiments][field]") {
  Numbers n;
  REQUIRE(set(n, "length_m", "0.1").empty());
  REQUIRE(n.length_m == 0.1);
  REQUIRE(set(n, "count", "7").empty());
  REQUIRE(n.count == 7);
  REQUIRE(set(n, "seed", "8999999999999999").empty());  // no detour over float
  REQUIRE(n.seed == 8999999999999999ULL);
  REQUIRE(set(n, "stress_Pa", "10e3,2.5e4,1").empty());
  REQUIRE(n.stress_Pa == std::vector<double>{10e3, 2.5e4, 1});
  n.length_m = 1.0 / 3;
  Numbers copy;
  for (const Field& f : fields(n)) REQUIRE(set(copy, f.name, field_text(f)).empty());
  REQUIRE(copy.length_m == n.length_m);
  REQUIRE(copy.seed == n.seed);
  REQUIRE(copy.stress_Pa == n.stress_Pa);
}

TEST_CASE("Fields: text that is no number leaves the value and says so", "[experiments][field]") {
  Numbers n;
  for (const char* text : {"", " 1", "1 ", "1x", "0,5", "one", "0x1"}) {
    INFO(text);
    REQUIRE_THAT(set(n, "length_m", text), Contains("length_m = '" + std::string(text) + "'"));
    REQUIRE(n.length_m == 0.5);
  }
  REQUIRE_THAT(set(n, "count", "2.5"), Contains("not a number this field can hold"));
  REQUIRE_THAT(set(n, "count", "99999999999"), Contains("not a number this field can hold"));
  REQUIRE_THAT(set(n, "seed", "-1"), Contains("not a number this field can hold"));
  for (const char* text : {"", ",", "1,", ",1", "1,,2", "1;2"}) {
    INFO(text);
    REQUIRE_THAT(set(n, "stress_Pa", text), Contains("not a number this field can hold"));
    REQUIRE(n.stress_Pa == std::vector<double>{1e3, 2e3});
  }
}

TEST_CASE("Fields: a number outside its closed range, or not finite, is named with the range",
          "[experiments][field]") {
  Numbers n;
  REQUIRE(range_problems(fields(n)).empty());
  REQUIRE(set(n, "length_m", "1").empty());
  REQUIRE(set(n, "length_m", "0").empty());
  REQUIRE_THAT(set(n, "length_m", "1.5"), Contains("length_m = 1.5: must be in [0, 1]"));
  REQUIRE_THAT(set(n, "length_m", "nan"), Contains("must be in"));
  REQUIRE_THAT(set(n, "length_m", "inf"), Contains("must be in"));
  n = Numbers{.length_m = -1, .count = 0, .stress_Pa = {0, 5, 1e7}};
  const std::vector<std::string> found = range_problems(fields(n));
  REQUIRE(found.size() == 4);  // both wrong entries of the list
  REQUIRE(found[1] == "count = 0: must be in [1, 10]");
  REQUIRE(find_field(fields(n), "lenght_m") == nullptr);
}

TEST_CASE("Fields: the defaults of every test and of the material are in range, names are unique",
          "[experiments][field]") {
  UnconfinedCompressionConfig unconfined;
  DirectShearConfig shear;
  ConfinedCompressionConfig confined;
  SoilMaterial material;
  REQUIRE(problems(material).empty());
  material.friction = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(problems(material).size() == 1);
  material = {};
  for (std::vector<Field> all : {fields(unconfined), fields(shear), fields(confined)}) {
    REQUIRE(range_problems(all).empty());
    for (const Field& f : fields(material)) all.push_back(f);
    std::set<std::string_view> names;
    for (const Field& f : all) REQUIRE(names.insert(f.name).second);
  }
}
