// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/effect_directions.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "calibrate/config_error.hpp"

using namespace tilth;
using Catch::Matchers::Contains;

namespace {

const std::filesystem::path shipped =
    std::filesystem::path(TILTH_SOURCE_DIR) / "data/effect_directions.csv";

}  // namespace

TEST_CASE("Directions: the shipped table, read back in three cells", "[calibrate][diagnosis]") {
  const DirectionTable table = read_effect_directions(shipped);
  REQUIRE(table.rows.size() == 24);  // 17 effects, 7 parameters of the toy's baseline
  REQUIRE(table.measures.size() == 33);
  const auto level = [&](const std::string& short_name, const std::string& measure) {
    for (const DirectionRow& row : table.rows)
      if (row.short_name == short_name) return row.levels[table.measure(measure)];
    return -99;
  };
  REQUIRE(level("ROLL", "aor_angle") == 3);
  REQUIRE(level("WEIB", "bt_scatter") == 3);
  REQUIRE(level("ADH", "dr_vertical") == -2);
  REQUIRE(level("CRUSH", "ds_dilation") == -3);
  REQUIRE(table.measure("no_such_measure") == -1);
  for (const DirectionRow& row : table.rows) REQUIRE(row.provenance == "expert_judgement");
}

TEST_CASE("Directions: a level that is none, and an id twice, are refused with their line",
          "[calibrate][diagnosis]") {
  std::ifstream in(shipped);
  std::stringstream text;
  text << in.rdbuf();
  std::string broken = text.str();
  broken.replace(broken.find(",ROLL,effect,positive,0,"), 24, ",ROLL,effect,positive,7,");
  broken += broken.substr(broken.find("damping,"));
  const auto file = std::filesystem::temp_directory_path() / "tilth_broken_directions.csv";
  std::ofstream(file) << broken;
  REQUIRE_THROWS_WITH(read_effect_directions(file), Contains("ucs_modulus = 7") &&
                                                        Contains("[-3, 3]") &&
                                                        Contains("'damping' stands here twice"));
  std::filesystem::remove(file);
}
