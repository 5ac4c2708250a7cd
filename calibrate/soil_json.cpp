// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <set>

#include "calibrate/soil_files.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {
namespace {

Origin read_origin(JsonObjectReader& entry) {
  Origin origin;
  const auto word = entry.required_choice("provenance", provenance_words());
  if (word) origin.provenance = *provenance_from_word(*word);
  origin.source = entry.required_text("source").value_or("");
  origin.locator = entry.required_text("locator").value_or("");
  return origin;
}

void check_quantity(const StateQuantity& quantity, JsonObjectReader& entry) {
  std::string reason;
  if (!has_si_name(quantity.quantity, &reason)) entry.problem("quantity", reason);
  const bool half_interval = quantity.lower.has_value() != quantity.upper.has_value();
  if (half_interval) entry.problem("", "an interval needs both lo and hi");
  if (quantity.lower && quantity.upper && !(*quantity.lower < *quantity.upper)) {
    entry.problem("lo",
                  fmt::format("lo = {} must be below hi = {}", *quantity.lower, *quantity.upper));
  }
  const bool is_fraction = quantity.quantity.ends_with("_fraction") ||
                           quantity.quantity.find("porosity") != std::string::npos;
  if (is_fraction && !(quantity.value >= 0.0 && quantity.value <= 1.0)) {
    entry.problem("value", fmt::format("{} = {}: must be in [0, 1]; given in percent?",
                                       quantity.quantity, quantity.value));
  }
  const bool is_density = quantity.quantity.find("density_kg_per_m3") != std::string::npos;
  if (is_density && !(quantity.value >= 300.0 && quantity.value <= 3500.0)) {
    entry.problem(
        "value", fmt::format("{} = {}: must be in [300, 3500]{}", quantity.quantity, quantity.value,
                             unit_hint(quantity.quantity, quantity.value, 300.0, 3500.0)));
  }
}

StateQuantity read_quantity(JsonObjectReader& entry) {
  StateQuantity quantity;
  quantity.quantity = entry.required_text("quantity").value_or("");
  const auto value = entry.required_number("value");
  quantity.value = value.value_or(0.0);
  quantity.sigma = entry.optional_number("sigma", {.lower = 0.0, .open_lower = true});
  const bool sigma_refused = entry.has("sigma") && !quantity.sigma;
  quantity.lower = entry.optional_number("lo");
  quantity.upper = entry.optional_number("hi");
  quantity.origin = read_origin(entry);
  entry.finish();
  if (value && !sigma_refused) check_quantity(quantity, entry);
  return quantity;
}

}  // namespace

void read_soil_json(const std::filesystem::path& file, SoilData& soil,
                    std::vector<std::string>& problems) {
  const JsonDocument document = read_json(file, problems);
  JsonObjectReader object(document, problems);
  if (!object.is_object()) return;
  object.schema("tilth.soil/1");
  soil.id = object.required_text("id").value_or("");
  soil.name = object.required_text("name").value_or("");
  soil.site = object.required_text("site").value_or("");
  std::set<std::string> seen;
  for (JsonObjectReader& entry : object.objects("state")) {
    StateQuantity quantity = read_quantity(entry);
    if (!quantity.quantity.empty() && !seen.insert(quantity.quantity).second) {
      entry.problem("quantity", fmt::format("'{}' occurs twice", quantity.quantity));
    }
    soil.state.push_back(std::move(quantity));
  }
  object.finish();
  if (!object.has("state")) object.problem("", "the key \"state\" is missing: must be a list");
}

}  // namespace tilth
