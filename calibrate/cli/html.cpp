// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/html.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace tilth {
namespace {

constexpr const char* style = R"(
body{font:15px/1.5 "DejaVu Sans",Helvetica,Arial,sans-serif;color:#222;max-width:1080px;margin:2em auto;padding:0 1.5em}
h1{font-size:1.5em;margin-bottom:.2em}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #ccc;padding-bottom:.2em}
table{border-collapse:collapse;margin:.8em 0;font-size:.9em}th,td{padding:.25em .7em;border-bottom:1px solid #e4e4e4;text-align:left;vertical-align:top}
th{border-bottom:2px solid #888}td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.share{font-weight:bold}.warn{background:#fff3d6;border-left:4px solid #c77d0a;padding:.5em 1em}.good{color:#2c6e29}.bad{color:#b02a3a}
figure{margin:1em 0}figure img{max-width:100%;border:1px solid #eee}figcaption{color:#555;font-size:.85em}
pre{background:#f5f5f5;padding:.8em;overflow-x:auto}nav a{margin-right:1em}small{color:#555}
)";

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int n = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                reinterpret_cast<const unsigned char*>(bytes.data()),
                                static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(n));
  return text;
}

bool looks_like_number(const std::string& cell) {
  if (cell == "-") return true;
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return end != cell.c_str() && (*end == '\0' || *end == ' ');
}

}  // namespace

std::string html_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string html_table(const HtmlTable& table) {
  std::string text = "<table><tr>";
  for (const std::string& h : table.headings) text += "<th>" + h + "</th>";
  text += "</tr>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (const std::string& cell : row)
      text += (looks_like_number(cell) ? "<td class=\"n\">" : "<td>") + cell + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string html_figure(const std::filesystem::path& svg, const std::string& caption) {
  std::ifstream in(svg, std::ios::binary);
  if (!in) return fmt::format("<p><small>no figure {}</small></p>\n", html_escaped(svg.filename().string()));
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return fmt::format("<figure><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\"><figcaption>{0}"
                     "</figcaption></figure>\n",
                     html_escaped(caption), base64(bytes));
}

std::string html_page(const std::string& title, const std::string& body) {
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title><style>{}"
                     "</style></head><body>\n{}</body></html>\n",
                     html_escaped(title), style, body);
}

}  // namespace tilth
