// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/profile_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calibrate/cli/figures.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

ProfileFigure figure_of(const SoilData& soil, const FitSummary& summary,
                        const ParameterProfile& profile) {
  const FittedParameter& p =
      *std::ranges::find(summary.parameters, profile.parameter, &FittedParameter::name);
  return {.title = fmt::format("{}: profile of {}: {}\ndrawn on {}", soil.name, p.name,
                               verdict_words(p), summary.profile_source),
          .x_label = p.name,
          .log_x = p.log_scale,
          .best = p.value,
          .low = p.lo95,
          .high = p.hi95,
          .level = summary.profile_level,
          .level_label = fmt::format("95 %: {:.3g}", summary.profile_level),
          .values = profile.values,
          .chi_square_difference = profile.chi_square_difference,
          .at_bound = profile.at_bound};
}

}  // namespace

std::string profile_csv(const SoilData& soil, const ParameterProfile& profile) {
  std::string text = profile.parameter + ",chi_square_difference,at_bound";
  for (const SoilParameter& p : soil.parameters)
    if (p.id != profile.parameter) text += "," + p.id;
  text += '\n';
  for (std::size_t i = 0; i < profile.values.size(); ++i) {
    const Eigen::VectorXd values = with_ties(soil.parameters, profile.points[i]);
    text += fmt::format("{:.10g},{:.6g},{}", profile.values[i], profile.chi_square_difference[i],
                        profile.at_bound[i]);
    for (std::size_t k = 0; k < soil.parameters.size(); ++k)
      if (soil.parameters[k].id != profile.parameter)
        text += fmt::format(",{:.10g}", values[static_cast<Eigen::Index>(k)]);
    text += '\n';
  }
  return text;
}

std::vector<std::string> write_profiles(const SoilData& soil, const FitSummary& summary,
                                        const std::filesystem::path& folder) {
  std::vector<std::string> missing;
  for (const ParameterProfile& profile : summary.profiles) {
    if (profile.values.empty()) continue;
    write_file(folder / "profiles" / (profile.parameter + ".csv"), profile_csv(soil, profile));
    const std::string name = "profile_" + profile.parameter + ".svg";
    const std::string why =
        draw_profile_figure(figure_of(soil, summary, profile), folder / "figures" / name);
    if (!why.empty()) missing.push_back(fmt::format("no figure {}: {}", name, why));
  }
  return missing;
}

}  // namespace tilth
