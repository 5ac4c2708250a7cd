// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Deck templates: readable text with @NAME@ where a value goes, embedded at build time.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tilth {

extern const std::string_view yade_template;
extern const std::string_view lammps_template;
extern const std::string_view liggghts_template;
extern const std::string_view pfc_template;

using TemplateValues = std::map<std::string, std::string>;

/// Replaces every @NAME@. @throws std::logic_error for a name without value or a value without name
std::string fill_template(std::string_view text, const TemplateValues& values);

/// Shortest text that reads back exactly.
std::string number_text(double value);

/// Lines behind a comment sign.
std::string comment_lines(std::string_view sign, const std::vector<std::string>& lines);

}  // namespace tilth
