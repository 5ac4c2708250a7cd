// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A small hand-made card, and a folder that is removed at the end.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tilth::export_test {

/// Every number differs from the defaults and from every other, so that a swap shows.
inline const std::string card_text = R"card({
  "schema": "tilth.card/1",
  "seed": 17, "status": "converged", "name": "test_loam",
  "engine": {"contact": "linear", "bond": "parallel", "preview": true},
  "provenance": {"measured_share": 0.5, "sentence": "measured targets: 1 of 2 (50 %)"},
  "parameters": [
    {"name": "bond_modulus_Pa", "value": 4e6, "lo95": 3e6, "hi95": 5e6, "role": "calibrated",
     "verdict": "identified"},
    {"name": "friction", "value": 0.45, "lo95": null, "hi95": null, "role": "calibrated-weak",
     "verdict": "flat"},
    {"name": "stiffness_ratio", "value": 2.5, "lo95": null, "hi95": null, "role": "fixed"}],
  "material": {
    "contact_modulus_Pa": 3e6, "stiffness_ratio": 2.5, "friction": 0.45, "wall_friction": 0.1,
    "rolling_friction": 0,
    "tool_friction": 0.3,
    "bond_modulus_Pa": 4e6, "bond_stiffness_ratio": 1.5, "bond_tensile_strength_Pa": 21000,
    "bond_cohesion_Pa": 32000, "bond_friction_angle_rad": 0.35, "bond_radius_multiplier": 0.9,
    "moment_contribution": 0.6, "local_damping": 0.65, "grain_density_kg_per_m3": 2500},
  "scope": {"valid_for": "element tests", "not_calibrated_for": "draught",
            "equivalent_at_radius": {"particle_radius_m": 0.003}},
  "warnings": ["friction is not fixed by the data"]
})card";

class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("tilth_export_test_" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
    std::ofstream(card()) << card_text;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path card() const { return path_ / "fit.json"; }
  static std::string read(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace tilth::export_test
