// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The pieces of a page that opens offline: one file, nothing fetched.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tilth {

/// Text with &, <, > and quotes written out.
std::string html_escaped(const std::string& text);

/// A table; cells are HTML already. Numbers are right-aligned by their look.
struct HtmlTable {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};
std::string html_table(const HtmlTable& table);

/// An SVG file as an image inside the page; a sentence where the file is missing.
std::string html_figure(const std::filesystem::path& svg, const std::string& caption);

/// The whole page with its style; `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tilth
