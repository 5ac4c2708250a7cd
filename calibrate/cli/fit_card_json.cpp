// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/fit_card.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/config_error.hpp"
#include "calibrate/soil_fit.hpp"
#include "calibrate/strict_json.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

Json material_json(SoilMaterial material) { return fields_json(fields(material)); }

Json test_json(TestConfig config) { return fields_json(fields(config)); }

std::string role_of(const SoilParameter& p, const FittedParameter& f) {
  if (p.tied_to) return "tied";
  if (!f.estimate) return "fixed";
  return f.verdict == ParameterVerdict::identified ? "calibrated" : "calibrated-weak";
}

Json parameters_json(const SoilData& soil, const FitSummary& summary) {
  const Eigen::VectorXd values = with_ties(soil.parameters, summary.values());
  Json list = Json::array();
  for (std::size_t k = 0; k < summary.parameters.size(); ++k) {
    const FittedParameter& f = summary.parameters[k];
    const SoilParameter& p = soil.parameters[k];
    Json entry = {{"name", f.name},
                  {"value", json_number(values[static_cast<Eigen::Index>(k)])},
                  {"lo95", json_number(f.lo95)},
                  {"hi95", json_number(f.hi95)},
                  {"role", role_of(p, f)}};
    if (p.tied_to) {
      entry["tied_to"] = fmt::format("{}*{}", p.tied_to->factor, p.tied_to->parameter_id);
      for (std::size_t m = 0; m < summary.parameters.size(); ++m)
        if (summary.parameters[m].name == p.tied_to->parameter_id) {
          entry["lo95"] = json_number(p.tied_to->factor * summary.parameters[m].lo95);
          entry["hi95"] = json_number(p.tied_to->factor * summary.parameters[m].hi95);
        }
    }
    if (f.estimate && !p.tied_to) {
      entry["standard_error"] = json_number(f.standard_error);
      entry["standard_error_of"] = f.log_scale ? "ln(value)" : "value";
      entry["standard_error_from_targets"] = json_number(f.standard_error_targets);
      entry["standard_error_from_packings"] = json_number(f.standard_error_packings);
      entry["profile_lo95"] = json_number(f.profile_lo95);
      entry["profile_hi95"] = json_number(f.profile_hi95);
      entry["verdict"] = std::string(to_string(f.verdict));
      if (!f.limited_by.empty()) entry["limited_by"] = f.limited_by;
      entry["start"] = json_number(f.start);
      entry["bounds"] = {json_number(f.lower), json_number(f.upper)};
      if (!f.no_error_bar.empty()) entry["no_error_bar_because"] = f.no_error_bar;
    }
    list.push_back(entry);
  }
  return list;
}

/// All parameters of one point by name, ties applied.
Json named_values_json(const SoilData& soil, const Eigen::VectorXd& point) {
  const Eigen::VectorXd values = with_ties(soil.parameters, point);
  Json object = Json::object();
  for (std::size_t k = 0; k < soil.parameters.size(); ++k)
    object[soil.parameters[k].id] = json_number(values[static_cast<Eigen::Index>(k)]);
  return object;
}

Json profiles_json(const SoilData& soil, const FitSummary& s) {
  Json curves = Json::array();
  for (const ParameterProfile& p : s.profiles) {
    Json points = Json::array();
    for (std::size_t i = 0; i < p.values.size(); ++i)
      points.push_back({{"value", json_number(p.values[i])},
                        {"chi_square_difference", json_number(p.chi_square_difference[i])},
                        {"at_bound", p.at_bound[i].empty() ? Json(nullptr) : Json(p.at_bound[i])},
                        {"parameters", named_values_json(soil, p.points[i])}});
    curves.push_back({{"name", p.parameter}, {"points", points}});
  }
  return {{"drawn_on", s.profile_source}, {"level", json_number(s.profile_level)}, {"curves", curves}};
}

Json family_json(const SoilData& soil, const FitSummary& s) {
  Json list = Json::array();
  for (const EquivalentSet& set : s.equivalence_family)
    list.push_back({{"chi_square_difference", json_number(set.chi_square_difference)},
                    {"parameters", named_values_json(soil, set.values)}});
  return list;
}

Json target_json(const TargetResult& t, const SoilTarget* source, bool holdout, int num_seeds) {
  Json entry = {{"name", t.name},
                {"holdout", holdout},
                {"target", json_number(t.value)},
                {"sigma", json_number(t.sigma)},
                {"sigma_of", t.log_transform ? "ln(value)" : "value"},
                {"sim", json_number(t.simulated)},
                {"sim_sd", json_number(t.seed_sd)},
                {"n_seeds", num_seeds},
                {"sigma_total", json_number(t.sigma_total)},
                {"residual", json_number(t.residual)},
                {"reachability", std::string(to_string(t.reachability))},
                {"reach_gap", json_number(t.reach_gap)},
                {"conflicts_with", t.conflicts_with},
                {"joint_misfit", json_number(t.joint_misfit)},
                {"bias", json_number(t.bias)},
                {"bias_error", json_number(t.bias_error)},
                {"provenance", std::string(to_string(t.provenance))}};
  if (holdout) entry["parameter_sd"] = json_number(t.parameter_sd);
  if (source) {
    entry["source"] = source->origin.source;
    entry["locator"] = source->origin.locator;
  }
  return entry;
}

Json responses_json(const SoilData& soil, const FitSummary& summary) {
  const std::vector<Target> targets = fit_targets(soil);
  const auto source = [&](const std::string& name) -> const SoilTarget* {
    for (std::size_t k = 0; k < targets.size(); ++k)
      if (targets[k].name == name) return &soil.targets[k];
    return nullptr;
  };
  Json list = Json::array();
  for (const TargetResult& t : summary.targets)
    list.push_back(target_json(t, source(t.name), false, summary.num_fresh_seeds));
  for (const TargetResult& t : summary.holdouts)
    list.push_back(target_json(t, source(t.name), true, summary.num_fresh_seeds));
  return list;
}

Json sample_sizes_json(const FitSummary& s) {
  Json list = Json::array();
  for (const CurveSampleSize& c : s.sample_sizes)
    list.push_back({{"curve", c.curve}, {"num_points", c.num_points}, {"effective", json_number(c.effective)}});
  return list;
}

Json matrix_json(const Eigen::MatrixXd& m) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(json_number(m(i, j)));
    rows.push_back(row);
  }
  return rows;
}

/// Mean grain radius of a confirming specimen: r with N 4/3 pi r^3 = (1 - n) V, size spread ignored.
double specimen_radius_m(Fidelity fidelity) {
  const auto c = std::get<UnconfinedCompressionConfig>(
      virtual_test("unconfined_compression", fidelity));
  const double volume_m3 =
      std::numbers::pi * c.specimen_radius_m * c.specimen_radius_m * c.specimen_height_m;
  return std::cbrt((1 - c.porosity) * volume_m3 / (4.0 / 3.0 * std::numbers::pi * c.num_particles));
}

Json scope_json(const SoilMaterial& m, const FitCardContext& context) {
  const double fine_m = specimen_radius_m(context.confirm);
  const double coarse_m = specimen_radius_m(context.search);
  const double bond_area_m2 = std::numbers::pi * fine_m * fine_m * m.bond.radius_multiplier *
                              m.bond.radius_multiplier;
  return {{"valid_for", "quasi-static element tests of the targets above, at the stated stresses"},
          {"not_calibrated_for",
           "soil displacement and draught, rate effects, other water contents, cyclic loading"},
          {"particle_radius_range_m", {fine_m, coarse_m}},
          {"equivalent_at_radius",
           {{"particle_radius_m", fine_m},
            {"contact_normal_stiffness_N_per_m",
             m.contact_modulus_Pa * std::numbers::pi * fine_m / 2},
            {"bond_normal_stiffness_N_per_m", m.bond.modulus_Pa * bond_area_m2 / (2 * fine_m)},
            {"bond_normal_stiffness_Pa_per_m", m.bond.modulus_Pa / (2 * fine_m)}}}};
}

Json failures_json(const FitSummary& summary) {
  Json list = Json::array();
  for (const FailedRun& f : summary.failures) {
    Json values = Json::object();
    for (std::size_t k = 0; k < summary.parameters.size(); ++k)
      values[summary.parameters[k].name] = json_number(f.parameters[static_cast<Eigen::Index>(k)]);
    list.push_back({{"stage", f.stage},
                    {"simulator", f.simulator},
                    {"seed", f.seed},
                    {"message", f.message},
                    {"parameters", values}});
  }
  return list;
}

Json gates_json(const FitSummary& s) {
  Json list = Json::array();
  for (const Gate& gate : s.gates)
    list.push_back({{"name", gate.name}, {"passed", gate.passed}, {"words", gate.words}});
  return list;
}

Json stages_json(const FitSummary& summary) {
  Json list = Json::array();
  for (const StageCount& s : summary.stages)
    list.push_back({{"stage", s.stage}, {"completed", s.num_completed}, {"failed", s.num_failed}});
  return list;
}

Json holdout_json(const FitSummary& s, const std::string& criterion) {
  return {{"criterion", criterion},
          {"prestated", true},
          {"rms_residual", json_number(s.holdout_rms)},
          {"limit", json_number(s.holdout_limit)},
          {"passed", s.holdouts.empty() ? Json(nullptr) : Json(!s.holdout_failed())}};
}

}  // namespace

std::string fit_card_json(const SoilData& soil, const FitSummary& s, const FitCardContext& c) {
  const SoilMaterial material = material_of(soil, s.values());
  Json card;
  card["schema"] = "tilth.card/1";
  card["tool"] = tool_json();
  card["inputs"] = inputs_json(c.inputs);
  card["seed"] = c.seed;
  card["status"] = std::string(to_string(s.termination));
  card["message"] = s.message;
  card["name"] = soil.id;
  card["soil"] = {{"id", soil.id}, {"name", soil.name}, {"site", soil.site}};
  card["engine"] = {{"contact", "linear, effective modulus, Coulomb slip with history"},
                    {"bond", "parallel bond, brittle (Potyondy & Cundall 2004)"},
                    {"preview", c.quick}};
  card["provenance"] = {{"measured_share", c.measured_share}, {"sentence", c.provenance_sentence}};
  card["parameters"] = parameters_json(soil, s);
  card["material"] = material_json(material);
  card["correlation"] = matrix_json(s.correlation);
  card["covariance"] = matrix_json(s.covariance);
  card["null_directions"] = s.null_directions;
  card["near_null_directions"] = s.near_null_directions;
  card["profiles"] = profiles_json(soil, s);
  card["equivalence_family"] = family_json(soil, s);
  card["responses"] = responses_json(soil, s);
  card["fit_statistics"] = {{"chi_square_start", json_number(s.chi_square_start)},
                            {"chi_square", json_number(s.chi_square)},
                            {"chi_square_fresh_seeds", json_number(s.chi_square_fresh)},
                            {"num_free", s.num_free},
                            {"num_observations", s.num_observations},
                            {"num_independent", s.num_independent},
                            {"sigma", s.sigma_is_rescaled
                                          ? "rescaled by reduced chi-square"
                                          : "absolute"},
                            {"num_starts", s.num_starts},
                            {"num_starts_at_best", s.num_starts_at_best},
                            {"effective_sample_sizes", sample_sizes_json(s)}};
  card["validation"] = holdout_json(s, c.criterion);
  card["scope"] = scope_json(material, c);
  card["gates"] = gates_json(s);
  card["warnings"] = s.warnings;
  card["failures"] = failures_json(s);
  card["cost"] = {{"num_simulations", s.num_simulations}, {"stages", stages_json(s)}};
  card["reproduction"] = {{"command", c.command}, {"tolerance", "byte for byte"}};
  return card.dump(2) + "\n";
}

std::string run_config_json(const SoilData& soil, const FitOptions& o, const FitCardContext& c) {
  Json config;
  config["schema"] = "tilth.run/1";
  config["tool"] = tool_json();
  config["soil"] = soil.id;
  config["quick"] = c.quick;
  config["fit"] = {{"seed", o.seed},
                   {"num_design", o.num_design},
                   {"num_noise_seeds", o.num_noise_seeds},
                   {"num_search_seeds", o.num_search_seeds},
                   {"num_confirm_seeds", o.num_confirm_seeds},
                   {"num_fresh_seeds", o.num_fresh_seeds},
                   {"num_rounds", o.num_rounds},
                   {"round_size", o.round_size},
                   {"num_starts", o.num_starts},
                   {"max_iterations", o.max_iterations},
                   {"max_bias_rounds", o.max_bias_rounds},
                   {"chi_square_tolerance", o.chi_square_tolerance},
                   {"function_tolerance", o.function_tolerance},
                   {"parameter_tolerance", o.parameter_tolerance},
                   {"secant_tolerance", o.secant_tolerance},
                   {"gradient_tolerance", o.gradient_tolerance},
                   {"rescale_sigma", o.rescale_sigma},
                   {"log_step", o.log_step},
                   {"linear_step", o.linear_step},
                   {"max_simulations", o.max_simulations},
                   {"holdout_limit", o.holdout_limit},
                   {"force", o.force}};
  config["parameters"] = Json::array();
  for (const SoilParameter& p : soil.parameters) {
    Json entry = {{"name", p.id},
                  {"scale", p.log_scale ? "log10" : "lin"},
                  {"nominal", p.nominal},
                  {"estimate", p.estimate && !p.tied_to}};
    if (p.estimate) entry["bounds"] = {p.lower, p.upper};
    if (p.tied_to)
      entry["tied_to"] = fmt::format("{}*{}", p.tied_to->factor, p.tied_to->parameter_id);
    config["parameters"].push_back(entry);
  }
  for (const auto& [key, fidelity] : {std::pair{"search", c.search}, std::pair{"confirm", c.confirm}})
    for (const PlannedTest& test : plan_tests(soil, fidelity))
      config["tests"][key].push_back({{"experiment", test_id(test.config)},
                                      {"condition", test.condition_id},
                                      {"setup", test_json(test.config)}});
  config["holdout_criterion"] = c.criterion;
  return config.dump(2) + "\n";
}

FittedSet read_fit_card(const std::filesystem::path& card_or_folder) {
  const std::filesystem::path file = std::filesystem::is_directory(card_or_folder)
                                         ? card_or_folder / "fit.json"
                                         : card_or_folder;
  std::vector<std::string> problems;
  const JsonDocument document = read_json(file, problems);
  if (!problems.empty()) throw ConfigError(problems);
  JsonObjectReader card(document, problems);
  card.schema("tilth.card/1");
  FittedSet set;
  set.soil_id = card.required_text("name").value_or("");
  set.status = card.text("status", "");
  set.seed = card.unsigned_integer("seed", 0);
  set.warnings = card.texts("warnings");
  if (auto engine = card.object("engine")) set.preview = engine->flag("preview", false);
  if (auto material = card.object("material")) {
    for (const Field& f : fields(set.material))
      // Cards written before there were effects do not name them: then there are none.
      if (const auto v = find_field(fields(set.material.effects), f.name)
                             ? material->optional_number(f.name, {f.lower, f.upper})
                             : material->required_number(f.name, {f.lower, f.upper}))
        *std::get<double*>(f.value) = *v;
    material->finish();
  } else {
    card.problem("material", "is missing: the card names no material");
  }
  if (auto provenance = card.object("provenance"))
    set.provenance_sentence = provenance->text("sentence", "");
  if (auto scope = card.object("scope")) {
    set.valid_for = scope->text("valid_for", "");
    set.not_calibrated_for = scope->text("not_calibrated_for", "");
    if (auto equivalent = scope->object("equivalent_at_radius"))
      set.particle_radius_m = equivalent->number("particle_radius_m", 0.0);
  }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (JsonObjectReader& p : card.objects("parameters")) {
    const auto interval = [&](const char* key) {
      const JsonNode* node = p.node(key);
      if (!node || std::holds_alternative<std::monostate>(node->value)) return unknown;
      return p.number(key, unknown);
    };
    set.parameters.push_back({p.required_text("name").value_or(""),
                              p.required_number("value").value_or(unknown), interval("lo95"),
                              interval("hi95"), p.text("role", ""), p.text("verdict", "")});
  }
  if (!problems.empty()) throw ConfigError(problems);
  return set;
}

std::string simulation_json(const TestConfig& config, const SoilMaterial& material,
                            const std::vector<std::uint64_t>& seeds,
                            const std::vector<ExperimentResult>& results,
                            const std::string& command) {
  Json out;
  out["schema"] = "tilth.simulation/1";
  out["tool"] = tool_json();
  out["experiment"] = test_id(config);
  out["material"] = material_json(material);
  out["setup"] = test_json(config);
  out["runs"] = Json::array();
  for (std::size_t k = 0; k < results.size(); ++k) {
    const ExperimentResult& r = results[k];
    Json features = Json::object();
    for (const Feature& f : r.features) features[f.name] = json_number(f.value);
    out["runs"].push_back({{"packing_seed", seeds[k]},
                           {"status", name_of(r.status)},
                           {"message", r.message},
                           {"features", features},
                           {"dt_s", r.dt_s},
                           {"num_steps", r.num_steps},
                           {"inertial_number", json_number(r.inertial_number)}});
  }
  out["reproduction"] = {{"command", command}};
  return out.dump(2) + "\n";
}

}  // namespace tilth
