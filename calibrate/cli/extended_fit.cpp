// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/extended_fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/cli/fit_card.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/fit.hpp"
#include "calibrate/fit_report.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

constexpr std::uint64_t first_seed_offset = 100'000;  ///< beyond all packings of the diagnosis

bool belongs_to(const CandidateChoice& choice, const std::string& parameter) {
  return std::ranges::find(choice.effect->parameters, parameter, &EffectParameter::name) != choice.effect->parameters.end();
}

/// The soil with the named effects as parameters of the fit, all starting where the refit ended.
SoilData extended_soil(const SoilCase& soil, const std::vector<NamedEffect>& names) {
  SoilData extended = soil.campaign.means;
  const Refit& refit = soil.models[1].refit;
  const Eigen::VectorXd values = physical_point(soil.parameters, refit.unit);
  std::erase_if(extended.parameters, [&](const SoilParameter& p) {
    return p.group == "effect" && std::ranges::none_of(names, [&](const NamedEffect& e) {
             return belongs_to(soil.choices[e.effect], p.id);
           });
  });
  for (std::size_t k = 0; k < soil.parameters.size(); ++k)
    for (SoilParameter& p : extended.parameters)
      if (p.id == soil.parameters[k].name && p.estimate) p.nominal = values[static_cast<Eigen::Index>(k)];
  for (std::size_t i = 0; i < names.size(); ++i) {
    const CandidateChoice& c = soil.choices[names[i].effect];
    for (SoilParameter& p : extended.parameters) {
      if (p.id == c.parameter->name) {
        p.nominal = refit.sizes[static_cast<Eigen::Index>(i)];
        p.estimate = true;
        p.role = "calibrated";
      }
      for (std::size_t n = 1; n < c.step.settings.size(); ++n)
        if (p.id == soil.parameters[static_cast<std::size_t>(c.step.settings[n].first)].name)
          p.nominal = c.step.settings[n].second;
    }
  }
  return extended;
}

}  // namespace

std::vector<std::string> write_extended_fits(const DiagnosisResult& result, const DiagnosisContext& diagnosis,
                                             const RunContext& context, const std::filesystem::path& folder) {
  const Diagnosis& d = result.diagnosis;
  if (d.effects.empty()) return {"no fit.json: nothing was named, so nothing is added"};
  std::vector<std::string> lines;
  for (const SoilCase& s : result.soils) {
    if (s.models.size() < 2 || !s.models[1].refit.is_usable) {
      lines.push_back(s.campaign.means.id + ": no fit.json: the model with the effect could not be simulated");
      continue;
    }
    const SoilData soil = extended_soil(s, d.effects);
    FitOptions options = diagnosis.preview ? quick_fit_options() : FitOptions{};
    options.seed = diagnosis.settings.seed + first_seed_offset;
    options.num_search_seeds = std::max(2, options.num_search_seeds);
    const Fidelity fidelity = diagnosis.settings.fidelity;
    const Simulator search = dem_simulator(soil, fidelity, context, TargetScope::fitted);
    const Simulator holdout = dem_simulator(soil, fidelity, context, TargetScope::holdouts);
    const bool has_holdouts = std::ranges::any_of(soil.targets, &SoilTarget::holdout);
    FitSummary summary =
        fit(fit_parameters(soil), fit_targets(soil), search, nullptr, options, has_holdouts ? &holdout : nullptr);
    show_ties(soil.parameters, summary);
    const FitCardContext card{.seed = options.seed,
                              .quick = diagnosis.preview,
                              .provenance_sentence = provenance_sentence(soil),
                              .measured_share = measured_share(soil.targets),
                              .search = fidelity,
                              .confirm = fidelity,
                              .command = diagnosis.command,
                              .inputs = diagnosis.inputs,
                              .criterion = "none: fitted by diagnose --apply; held-out data are judged in diagnosis.json"};
    const std::filesystem::path own = result.soils.size() > 1 ? folder / soil.id : folder;
    write_file(own / "fit.json", fit_card_json(soil, summary, card));
    write_file(own / "fit_report.txt", fit_report_text(summary, ReportContext{card.provenance_sentence}));
    lines.push_back((own / "fit.json").string() + ": " + summary.brief_report());
  }
  return lines;
}

}  // namespace tilth
