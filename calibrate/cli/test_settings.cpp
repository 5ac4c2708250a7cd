// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/test_settings.hpp"

#include <fmt/format.h>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/soil_choice.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/nearest_name.hpp"

namespace tilth {

std::optional<SoilData> soil_of(const MaterialSource& source) {
  if (source.fit.empty() || !source.soil_folder.empty())
    return load_soil(chosen_soil_folder(source.soil, source.soil_folder));
  const std::filesystem::path shipped = data_root() / "soils" / read_fit_card(source.fit).soil_id;
  return std::filesystem::exists(shipped) ? std::optional<SoilData>(load_soil(shipped)) : std::nullopt;
}

SoilMaterial starting_material(const MaterialSource& source, TestConfig& config,
                               std::vector<std::string>& problems) {
  const std::optional<SoilData> soil = soil_of(source);
  if (soil) apply_soil_state(config, *soil);
  if (source.fit.empty()) return material_of(*soil, nominal_values(*soil));
  const FittedSet set = read_fit_card(source.fit);
  if (!source.soil.empty() && set.soil_id != source.soil)
    problems.push_back(
        fmt::format("--fit {} is of soil {}, --soil says {}", source.fit, set.soil_id, source.soil));
  return set.material;
}

void apply_settings(const std::string& option, const std::vector<std::string>& settings,
                    TestConfig& config, SoilMaterial& material, std::vector<std::string>& problems) {
  std::vector<Field> all = fields(config);
  for (const Field& f : fields(material)) all.push_back(f);
  std::vector<std::string> names;
  for (const Field& f : all) names.emplace_back(f.name);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    if (equals == std::string::npos) {
      problems.push_back(fmt::format("{} {}: must be key=value", option, setting));
      continue;
    }
    const Field* field = find_field(all, key);
    const std::string wrong = field
                                  ? set_field(*field, std::string_view(setting).substr(equals + 1))
                                  : unknown_name_sentence("number", key, names);
    if (!wrong.empty()) problems.push_back(fmt::format("{} {}: {}", option, setting, wrong));
  }
}

void refuse_bad_test(std::vector<std::string> found, const TestConfig& config,
                     const SoilMaterial& material) {
  if (!found.empty()) throw ConfigError(found);
  for (const std::string& p : problems(config)) found.push_back(p);
  for (const std::string& p : problems(material)) found.push_back(p);
  if (!found.empty()) throw ConfigError(found);
}

}  // namespace tilth
