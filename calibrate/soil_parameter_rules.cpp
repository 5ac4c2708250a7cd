// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// What parameters must obey, whether they come from parameters.csv or from a config file.
#include <fmt/format.h>

#include <cmath>

#include "calibrate/nearest_name.hpp"
#include "calibrate/soil_files.hpp"

namespace tilth {
namespace {

void check_bounds(const SoilParameter& p, std::vector<std::string>& found) {
  const bool ordered = p.estimate ? p.lower < p.upper : p.lower <= p.upper;
  if (!ordered) {
    found.push_back(fmt::format("{}: lower = {} must be below upper = {}", p.id, p.lower, p.upper));
  } else if (p.nominal < p.lower || p.nominal > p.upper) {
    found.push_back(fmt::format("{}: nominal = {} must be in [lower, upper] = [{}, {}]", p.id,
                                p.nominal, p.lower, p.upper));
  }
  if (p.log_scale && !(p.lower > 0.0 && p.nominal > 0.0)) {
    found.push_back(fmt::format("{}: scale log10 needs lower > 0 and nominal > 0", p.id));
  }
}

void check_range(const SoilParameter& p, const KnownParameter& known,
                 std::vector<std::string>& found) {
  const auto check = [&](const char* what, double number) {
    if (number >= known.lower && number <= known.upper) return;
    found.push_back(fmt::format("{}: {} = {} is not possible, must be in [{}, {}]", p.id, what,
                                number, known.lower, known.upper));
  };
  check("nominal", p.nominal);
  if (p.lower != p.nominal) check("lower", p.lower);
  if (p.upper != p.nominal) check("upper", p.upper);
}

void check_prior(const SoilParameter& p, std::vector<std::string>& found) {
  if (p.prior == PriorKind::none) return;
  if (p.prior == PriorKind::uniform) {
    if (!(p.prior_p1 < p.prior_p2)) {
      found.push_back(fmt::format("{}: uniform prior: prior_p1 = {} must be below prior_p2 = {}",
                                  p.id, p.prior_p1, p.prior_p2));
    } else if (!(p.prior_p1 < p.upper && p.prior_p2 > p.lower)) {
      found.push_back(fmt::format("{}: uniform prior [{}, {}] lies outside [lower, upper]", p.id,
                                  p.prior_p1, p.prior_p2));
    }
    return;
  }
  if (!(p.prior_p2 > 0.0)) {
    found.push_back(fmt::format("{}: prior_p2 = {}: the deviation must be > 0", p.id, p.prior_p2));
  }
  if (p.prior == PriorKind::log_normal && !(p.log_scale && p.prior_p1 > 0.0)) {
    found.push_back(p.id + ": a log_normal prior needs scale log10 and a median prior_p1 > 0");
  }
  if (p.prior == PriorKind::normal && p.log_scale) {
    found.push_back(p.id + ": a normal prior needs scale lin; with scale log10 use log_normal");
  }
}

const SoilParameter* master_of(const std::vector<SoilParameter>& parameters,
                               const SoilParameter& parameter) {
  if (!parameter.tied_to) return nullptr;
  for (const SoilParameter& other : parameters) {
    if (other.id == parameter.tied_to->parameter_id) return &other;
  }
  return nullptr;
}

/// "a -> b -> a" when the ties of `first` lead back to it, else "".
std::string circle_through(const std::vector<SoilParameter>& parameters,
                           const SoilParameter& first) {
  std::string path = first.id;
  const SoilParameter* at = master_of(parameters, first);
  for (std::size_t steps = 0; at != nullptr && steps < parameters.size(); ++steps) {
    path += " -> " + at->id;
    if (at == &first) return path;
    at = master_of(parameters, *at);
  }
  return "";
}

}  // namespace

std::vector<std::string> parameter_problems(const SoilParameter& parameter,
                                            const KnownParameter* known) {
  std::vector<std::string> found;
  check_bounds(parameter, found);
  if (known != nullptr) check_range(parameter, *known, found);
  check_prior(parameter, found);
  if (parameter.tied_to && parameter.estimate) {
    found.push_back(parameter.id + " is tied and estimated: choose one of both");
  }
  if (parameter.tied_to && !(parameter.tied_to->factor > 0.0)) {
    found.push_back(fmt::format("{}: the factor {} of the tie must be > 0", parameter.id,
                                parameter.tied_to->factor));
  }
  return found;
}

std::vector<std::pair<std::size_t, std::string>> tie_problems(
    const std::vector<SoilParameter>& parameters) {
  std::vector<std::string> ids;
  for (const SoilParameter& parameter : parameters) ids.push_back(parameter.id);
  std::vector<std::pair<std::size_t, std::string>> found;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const SoilParameter& parameter = parameters[i];
    if (!parameter.tied_to) continue;
    if (master_of(parameters, parameter) == nullptr) {
      found.emplace_back(i, "tied_to: " + unknown_name_sentence(
                                              "parameter", parameter.tied_to->parameter_id, ids));
    } else if (const std::string circle = circle_through(parameters, parameter); !circle.empty()) {
      found.emplace_back(i, "tied_to goes in a circle: " + circle);
    }
  }
  return found;
}

}  // namespace tilth
