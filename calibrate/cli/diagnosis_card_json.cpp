// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/card_parts_json.hpp"
#include "calibrate/cli/diagnosis_report.hpp"
#include "calibrate/cli/solver_version.hpp"
#include "calibrate/diagnosis/gap_size.hpp"
#include "calibrate/diagnosis/thresholds.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

using Json = nlohmann::ordered_json;

Json named_json(const DiagnosisResult& r) {
  Json list = Json::array();
  for (const NamedEffect& e : r.diagnosis.effects) {
    Json sizes = Json::array();
    for (std::size_t s = 0; s < e.sizes.size(); ++s)
      sizes.push_back({{"soil", r.diagnosis.soils[s].soil},
                       {"value", json_number(e.sizes[s].value)},
                       {"lo90", json_number(e.sizes[s].lo90)},
                       {"hi90", json_number(e.sizes[s].hi90)}});
    const CandidateChoice& c = r.soils.front().choices[e.effect];
    list.push_back({{"id", e.id},
                    {"parameter", c.parameter->name},
                    {"size", sizes.empty() ? Json(nullptr) : sizes[0]["value"]},
                    {"interval", sizes.empty() ? Json(nullptr) : Json{sizes[0]["lo90"], sizes[0]["hi90"]}},
                    {"interval_level", 0.9},
                    {"sizes", sizes},
                    {"posterior", json_number(e.posterior)},
                    {"stability", json_number(e.stability)},
                    {"num_supporting_experiments", e.num_supporting_experiments}});
  }
  return list;
}

Json model_json(const SoilCase& soil, const RefittedModel& m) {
  Json gaps = Json::array();
  for (const ExperimentGap& g : m.gaps)
    gaps.push_back({{"experiment", g.experiment.empty() ? "all" : g.experiment},
                    {"held_out", g.holdout},
                    {"num_statistics", g.num_statistics},
                    {"gap", json_number(g.gap)}});
  Json parameters = Json::object(), sizes = Json::array();
  if (m.refit.is_usable) {
    const Eigen::VectorXd values =
        with_ties(soil.campaign.means.parameters, physical_point(soil.parameters, m.refit.unit));
    for (const std::size_t j : free_parameters(soil.parameters))
      parameters[soil.parameters[j].name] = values[static_cast<Eigen::Index>(j)];
    for (const double size : m.refit.sizes) sizes.push_back(size);
  }
  return {{"effects", m.effects},       {"usable", m.refit.is_usable},
          {"sizes", sizes},             {"parameters", parameters},
          {"chi_square", json_number(m.refit.chi_square)}, {"gaps", gaps}};
}

Json scores_json(const DiagnosisResult& r, std::size_t s) {
  Json list = Json::array();
  const SoilCase& soil = r.soils[s];
  const SoilDiagnosis& d = r.diagnosis.soils[s];
  for (std::size_t k = 0; k < d.scores.size(); ++k) {
    const EffectScore& e = d.scores[k];
    list.push_back({{"id", soil.choices[k].candidate.id},
                    {"decision", std::string(to_string(e.decision))},
                    {"z", json_number(e.z)},
                    {"expected_change", json_number(e.expected_change)},
                    {"standard_error", json_number(e.standard_error)},
                    {"typical", soil.choices[k].candidate.typical},
                    {"smallest_visible", json_number(e.smallest_visible)},
                    {"power", json_number(e.power)},
                    {"kept", json_number(e.kept)},
                    {"posterior", json_number(r.diagnosis.posterior.inclusion.size() > 0
                                                  ? r.diagnosis.posterior.inclusion[static_cast<Eigen::Index>(k)]
                                                  : 0.0)},
                    {"adjusted_tail", json_number(d.adjusted_tails.size() > 0 ? d.adjusted_tails[static_cast<Eigen::Index>(k)]
                                                                              : std::nan(""))},
                    {"not_simulated_because", soil.simulated.not_simulated[k]}});
  }
  return list;
}

/// Correlation of the fingerprints of two candidates, what the fit can take up removed; pairs of 0.5 and more in size.
Json look_alikes_json(const SoilCase& soil, const SoilDiagnosis& d) {
  constexpr double least = 0.5;
  Json list = Json::array();
  for (Eigen::Index a = 0; a < d.look_alikes.rows(); ++a)
    for (Eigen::Index b = a + 1; b < d.look_alikes.cols(); ++b)
      if (std::abs(d.look_alikes(a, b)) >= least)
        list.push_back({{"first", soil.choices[static_cast<std::size_t>(a)].candidate.id},
                        {"second", soil.choices[static_cast<std::size_t>(b)].candidate.id},
                        {"correlation", json_number(d.look_alikes(a, b))}});
  return list;
}

Json soil_json(const DiagnosisResult& r, std::size_t s) {
  const SoilCase& soil = r.soils[s];
  Json j = {{"soil", soil.campaign.means.id}, {"remarks", soil.remarks}, {"no_evidence_because", soil.failure}};
  Json gates = Json::array(), models = Json::array();
  for (const NumericalGate& g : soil.gates)
    gates.push_back({{"id", g.id},
                     {"known", g.is_known},
                     {"passed", g.passed()},
                     {"largest_shift_over_noise", json_number(g.largest_shift)},
                     {"statistic", g.statistic}});
  for (const RefittedModel& m : soil.models) models.push_back(model_json(soil, m));
  j["numerical_gates"] = gates;
  j["models"] = models;
  if (s < r.diagnosis.soils.size()) {
    const SoilDiagnosis& d = r.diagnosis.soils[s];
    j["detection"] = {{"chi_square", json_number(d.gap.chi_square)},
                      {"degrees_of_freedom", json_number(d.gap.nu)},
                      {"tail_probability", json_number(d.gap.tail_probability)},
                      {"bootstrap_tail", json_number(d.bootstrap_tail)}};
    j["candidates"] = scores_json(r, s);
    j["look_alikes"] = look_alikes_json(soil, d);
  }
  return j;
}

Json gap_json(const DiagnosisResult& r, std::size_t model) {
  const auto fitted = overall_gap(r.soils, model, false), held = overall_gap(r.soils, model, true);
  return {{"fitted", fitted ? json_number(*fitted) : Json(nullptr)}, {"held_out", held ? json_number(*held) : Json(nullptr)}};
}

Json settings_json(const DiagnosisSettings& s) {
  namespace t = diagnosis_thresholds;
  return {{"fidelity", name_of(s.fidelity)},
          {"seed", s.seed},
          {"num_residual_packings", s.num_residual_packings},
          {"num_derivative_packings", s.num_derivative_packings},
          {"num_refit_packings", s.num_refit_packings},
          {"num_resamples", s.statistics.num_resamples},
          {"num_repetitions", s.statistics.num_repetitions},
          {"thresholds",
           {{"name_probability", t::name_probability},
            {"set_probability", t::set_probability},
            {"least_stability", t::least_stability},
            {"gap_level", t::gap_level},
            {"residual_level", t::residual_level}}}};
}

}  // namespace

std::string diagnosis_json(const DiagnosisResult& r, const DiagnosisContext& context) {
  const Diagnosis& d = r.diagnosis;
  Json unseen = Json::array(), advice = Json::array(), soils = Json::array();
  for (std::size_t s = 0; s < d.soils.size(); ++s)
    for (std::size_t k = 0; k < d.soils[s].scores.size(); ++k) {
      const EffectDecision decision = d.soils[s].scores[k].decision;
      if (decision == EffectDecision::not_measurable || decision == EffectDecision::inconclusive)
        unseen.push_back({{"soil", d.soils[s].soil}, {"id", r.soils[s].choices[k].candidate.id}});
    }
  for (const ExperimentAdvice& a : r.advice)
    advice.push_back({{"experiment", a.name},
                      {"separation_before", json_number(a.separation_before)},
                      {"separation_after", json_number(a.separation_after)},
                      {"ordering_before", json_number(a.ordering_before)},
                      {"ordering_after", json_number(a.ordering_after)}});
  for (std::size_t s = 0; s < r.soils.size(); ++s) soils.push_back(soil_json(r, s));
  const bool has_models = !r.soils.empty() && r.soils.front().models.size() > 1;
  const Json card = {{"schema", "tilth.diagnosis/1"},
                     {"verdict", std::string(to_string(d.verdict))},
                     {"sentence", verdict_sentence(r)},
                     {"reason", d.reason},
                     {"preview", context.preview},
                     {"provenance", context.provenance_sentence},
                     {"effects", named_json(r)},
                     {"set", d.set},
                     {"set_holds_none", d.set_holds_none},
                     {"set_holds_other", d.set_holds_other},
                     {"posterior_none", json_number(d.posterior.none)},
                     {"posterior_other", json_number(d.posterior.other)},
                     {"gap_before", has_models ? gap_json(r, 0) : Json(nullptr)},
                     {"gap_after", has_models ? gap_json(r, 1) : Json(nullptr)},
                     {"could_not_have_been_seen", unseen},
                     {"next_experiments", advice},
                     {"soils", soils},
                     {"settings", settings_json(context.settings)},
                     {"num_simulations", context.num_simulations},
                     {"num_failed", context.num_failed},
                     {"reproduction",
                      {{"command", context.command},
                       {"tool", tool_json()},
                       {"solver", solver_version},
                       {"inputs", inputs_json(context.inputs)}}}};
  return card.dump(2) + "\n";
}

std::string diagnosis_config_json(const std::vector<SoilCase>& soils, const DiagnosisSettings& settings, bool preview) {
  Json list = Json::array();
  for (const SoilCase& s : soils) {
    Json targets = Json::array(), parameters = Json::array();
    for (const Target& t : s.targets)
      targets.push_back({{"name", t.name}, {"value", t.value}, {"sigma", t.sigma}, {"held_out", t.holdout}});
    for (const Parameter& p : s.parameters)
      parameters.push_back({{"name", p.name}, {"lower", p.lower}, {"upper", p.upper}, {"start", p.start}, {"estimate", p.estimate}});
    list.push_back({{"soil", s.campaign.means.id}, {"targets", targets}, {"parameters", parameters}});
  }
  const Json config = {{"command", "diagnose"}, {"preview", preview}, {"settings", settings_json(settings)}, {"soils", list}};
  return config.dump(2) + "\n";
}

}  // namespace tilth
