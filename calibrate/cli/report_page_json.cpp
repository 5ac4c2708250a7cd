// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calibrate/cli/command_report.hpp"
#include "calibrate/cli/html.hpp"
#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string number(const Json& value, const char* digits = "{:.4g}") {
  return value.is_number() ? fmt::format(fmt::runtime(digits), value.get<double>()) : "-";
}

std::string number_at(const Json& object, const char* key, const char* digits = "{:.4g}") {
  return object.contains(key) ? number(object.at(key), digits) : "-";
}

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? html_escaped(found->get<std::string>()) : "";
}

std::string interval(const Json& p, const char* low, const char* high) {
  const std::string a = number_at(p, low), b = number_at(p, high);
  return a == "-" && b == "-" ? "-" : fmt::format("[{}, {}]", a, b);
}

std::string coloured(const std::string& word, bool good) {
  return fmt::format("<span class=\"{}\">{}</span>", good ? "good" : "bad", word);
}

Json read(const fs::path& file) {
  std::ifstream in(file);
  return in ? Json::parse(in, nullptr, false) : Json();
}

/// "bound_limited (by friction)".
std::string verdict_words(const Json& p) {
  const std::string by = text_at(p, "limited_by");
  return by.empty() ? text_at(p, "verdict") : fmt::format("{} (by {})", text_at(p, "verdict"), by);
}

std::string head(const Json& card) {
  const Json& soil = card.at("soil");
  std::string text = fmt::format("<p class=\"share\">{}</p>\n<h1>{}</h1>\n<p>{}</p>\n",
                                 text_at(card.at("provenance"), "sentence"), text_at(soil, "name"),
                                 text_at(soil, "site"));
  if (card.at("engine").value("preview", false))
    text += "<p class=\"warn\">PREVIEW (--quick): small, fast specimens and few packings; do not publish these numbers</p>\n";
  return text + fmt::format("<p><b>{}</b>: {}</p>\n"
                            "<nav><a href=\"#fit\">fit</a><a href=\"#targets\">targets</a><a href=\"#known\">how well known</a>"
                            "<a href=\"#holdout\">hold-out</a><a href=\"#curves\">curves</a><a href=\"#failures\">failures</a>"
                            "<a href=\"#cost\">cost</a><a href=\"#again\">reproduce</a></nav>\n",
                            text_at(card, "status"), text_at(card, "message"));
}

std::string fit_section(const Json& card) {
  HtmlTable table{{"parameter", "value", "standard error", "linear 95 %", "profile 95 %", "from targets",
                   "from packings", "verdict"}, {}};
  HtmlTable held{{"held parameter", "value", ""}, {}};
  for (const Json& p : card.at("parameters")) {
    if (!p.contains("verdict")) {
      held.rows.push_back({text_at(p, "name"), number_at(p, "value", "{:.6g}"),
                           p.contains("tied_to") ? "= " + text_at(p, "tied_to") : text_at(p, "role")});
      continue;
    }
    const std::string why = text_at(p, "no_error_bar_because");
    table.rows.push_back(
        {text_at(p, "name"), number_at(p, "value", "{:.5g}"),
         why.empty() ? number_at(p, "standard_error", "{:.3g}") +
                           (p.value("standard_error_of", "") == "ln(value)" ? " of ln" : "")
                     : "no error bar because " + why,
         interval(p, "lo95", "hi95"), interval(p, "profile_lo95", "profile_hi95"),
         number_at(p, "standard_error_from_targets", "{:.3g}"),
         number_at(p, "standard_error_from_packings", "{:.3g}"),
         coloured(verdict_words(p), text_at(p, "verdict") == "identified")});
  }
  const Json& s = card.at("fit_statistics");
  std::string text = "<h2 id=\"fit\">Fit</h2>\n" + html_table(table);
  text += fmt::format("<p>chi-square {} at the start (one packing), {} at the end, {} on packings no stage had seen; {} "
                      "targets, {} free parameters, {} independent observations; sigma: {}; best value found {} times of {} starts.</p>\n",
                      number_at(s, "chi_square_start"), number_at(s, "chi_square"),
                      number_at(s, "chi_square_fresh_seeds"), number_at(s, "num_observations"),
                      number_at(s, "num_free"), number_at(s, "num_independent"), text_at(s, "sigma"),
                      number_at(s, "num_starts_at_best"), number_at(s, "num_starts"));
  HtmlTable gates{{"gate before the search", "", ""}, {}};
  for (const Json& g : card.value("gates", Json::array()))
    gates.rows.push_back({text_at(g, "name"), coloured(g.value("passed", false) ? "passed" : "failed", g.value("passed", false)),
                          text_at(g, "words")});
  if (!gates.rows.empty()) text += html_table(gates);
  for (const Json& w : card.at("warnings"))
    if (w.is_string()) text += "<p class=\"warn\">" + html_escaped(w.get<std::string>()) + "</p>\n";
  return text + "<details><summary>parameters that were held</summary>" + html_table(held) + "</details>\n";
}

/// "test/observable/condition" that may be broken at the slashes.
std::string breakable(std::string name) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 6))
    name.insert(at + 1, "<wbr>");
  return name;
}

/// The sources of a table, each once: "[1]" in the table, in full below it.
struct Sources {
  std::vector<std::string> texts;
  std::string mark(const std::string& text) {
    if (text.empty()) return "";
    const auto found = std::ranges::find(texts, text) - texts.begin();
    if (found == static_cast<std::ptrdiff_t>(texts.size())) texts.push_back(text);
    return fmt::format(" <small>[{}]</small>", found + 1);
  }
  std::string list() const {
    std::string all = "<p><small>";
    for (std::size_t k = 0; k < texts.size(); ++k)
      all += fmt::format("[{}] {}<br>", k + 1, texts[k]);
    return all + "</small></p>\n";
  }
};

std::string response_table(const Json& card, bool holdout) {
  Sources sources;
  HtmlTable table{{"target", "target value", "sigma", "simulated", "one packing &plusmn;", "residual",
                   holdout ? "from parameters" : "reachability", "bias of the search", "provenance"}, {}};
  for (const Json& r : card.at("responses")) {
    if (r.value("holdout", false) != holdout) continue;
    const std::string ln = r.value("sigma_of", "") == "ln(value)" ? " of ln" : "";
    const std::string word = text_at(r, "reachability");
    std::string reach = holdout ? number_at(r, "parameter_sd", "{:.3g}")
                                : coloured(word, word == "reachable");
    const std::string other = text_at(r, "conflicts_with");
    if (word == "unreachable" && other.empty())
      reach += fmt::format(" <small>({} sigma)</small>", number_at(r, "reach_gap", "{:.2g}"));
    if (!other.empty())
      reach += fmt::format("<br><small>not together with {} ({} sigma)</small>", other,
                           number_at(r, "joint_misfit", "{:.2g}"));
    const double residual = r.at("residual").is_number() ? r.at("residual").get<double>() : NAN;
    table.rows.push_back({breakable(text_at(r, "name")), number_at(r, "target"), number_at(r, "sigma", "{:.3g}") + ln,
                          number_at(r, "sim"), number_at(r, "sim_sd", "{:.3g}") + ln,
                          std::abs(residual) > 2 ? coloured(number_at(r, "residual", "{:+.2f}"), false)
                                                 : number_at(r, "residual", "{:+.2f}"),
                          reach, number_at(r, "bias", "{:.3g}"),
                          text_at(r, "provenance") + sources.mark(text_at(r, "source"))});
  }
  return html_table(table) + sources.list();
}

std::string targets_section(const Json& card, const fs::path& folder) {
  return "<h2 id=\"targets\">Targets</h2>\n"
         "<p>Residuals in total sigma; reachable: inside what the model gave in all search runs.</p>\n" +
         response_table(card, false) +
         html_figure(folder / "figures" / "targets.svg", "simulated against target, in total sigma");
}

std::string known_section(const Json& card, const fs::path& folder) {
  std::string text = "<h2 id=\"known\">How well the parameters are known</h2>\n";
  std::vector<std::string> names;
  for (const Json& p : card.at("parameters"))
    if (p.contains("verdict")) names.push_back(p.value("name", ""));
  HtmlTable table{{""}, {}};
  for (const std::string& name : names) table.headings.push_back(html_escaped(name));
  const Json& c = card.at("correlation");
  for (std::size_t i = 0; i < c.size() && i < names.size(); ++i) {
    std::vector<std::string> row = {html_escaped(names[i])};
    for (const Json& value : c[i]) row.push_back(number(value, "{:+.3f}"));
    table.rows.push_back(row);
  }
  if (!table.rows.empty()) text += "<h3>Correlations</h3>\n" + html_table(table);
  for (const char* key : {"null_directions", "near_null_directions"})
    if (card.contains(key))
      for (const Json& d : card.at(key))
        if (d.is_string()) text += "<p>not fixed by the data: " + html_escaped(d.get<std::string>()) + "</p>\n";
  for (const std::string& name : names)
    if (const fs::path svg = folder / "figures" / ("profile_" + name + ".svg"); fs::exists(svg))
      text += html_figure(svg, "profile of " + name);
  if (card.contains("equivalence_family"))
    text += fmt::format("<p>{} parameter sets fit equally well within the noise; they are in fit.json under equivalence_family.</p>\n",
                        card.at("equivalence_family").size());
  return text;
}

std::string holdout_section(const Json& card) {
  const Json& v = card.at("validation");
  std::string text = "<h2 id=\"holdout\">Hold-out</h2>\n";
  if (!v.at("passed").is_boolean()) return text + "<p>No target was held out, or none could be predicted.</p>\n";
  return text +
         fmt::format("<p>Criterion, written before the fit: {}. Found: {}: {}.</p>\n", text_at(v, "criterion"),
                     number_at(v, "rms_residual", "{:.3g}"),
                     v.at("passed").get<bool>() ? coloured("passed", true) : coloured("failed", false)) +
         response_table(card, true);
}

std::string curves_section(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder / "figures"))
    for (const auto& entry : fs::directory_iterator(folder / "figures")) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".svg") && name != "targets.svg" && !name.starts_with("profile_"))
        files.push_back(entry.path());
    }
  std::ranges::sort(files);
  std::string text = "<h2 id=\"curves\">Curves at the fitted values</h2>\n";
  for (const fs::path& f : files) text += html_figure(f, f.stem().string());
  return files.empty() ? text + "<p>none were drawn</p>\n" : text;
}

std::string failures_section(const Json& card) {
  HtmlTable table{{"stage", "simulator", "packing", "why"}, {}};
  for (const Json& f : card.at("failures"))
    table.rows.push_back({text_at(f, "stage"), text_at(f, "simulator"), number_at(f, "seed", "{:.0f}"), text_at(f, "message")});
  const std::string count = fmt::format("<h2 id=\"failures\">Failures</h2>\n<p>{} of {} simulations failed; none became a number.</p>\n",
                                        table.rows.size(), number_at(card.at("cost"), "num_simulations", "{:.0f}"));
  return table.rows.empty() ? count : count + html_table(table);
}

std::string cost_section(const Json& card, const Json& timing) {
  HtmlTable table{{"stage", "completed", "failed"}, {}};
  for (const Json& s : card.at("cost").at("stages"))
    table.rows.push_back({text_at(s, "stage"), number_at(s, "completed", "{:.0f}"), number_at(s, "failed", "{:.0f}")});
  std::string text = "<h2 id=\"cost\">What it cost</h2>\n" + html_table(table);
  if (!timing.is_object()) return text;
  return text + fmt::format("<p>Last start: {} s on {} workers, {} core-seconds of them; {} tests simulated, {} taken from the store, {} started again.</p>\n",
                            number_at(timing, "wall_s", "{:.0f}"), number_at(timing, "workers", "{:.0f}"),
                            number_at(timing, "worker_s", "{:.0f}"), number_at(timing, "runs_simulated", "{:.0f}"),
                            number_at(timing, "runs_from_store", "{:.0f}"), number_at(timing, "runs_retried", "{:.0f}"));
}

std::string again_section(const Json& card) {
  HtmlTable inputs{{"input", "SHA-256"}, {}};
  for (const Json& i : card.at("inputs")) inputs.rows.push_back({text_at(i, "path"), "<code>" + text_at(i, "sha256") + "</code>"});
  const Json& tool = card.at("tool");
  const Json& scope = card.at("scope");
  return fmt::format("<h2 id=\"again\">Reproduce</h2>\n<pre>{}</pre>\n<p>{} {} (commit {}), {}; result: {}.</p>\n{}"
                     "<p>Valid for: {}. Not calibrated for: {}.</p>\n",
                     text_at(card.at("reproduction"), "command"), text_at(tool, "name"), text_at(tool, "version"),
                     text_at(tool, "commit"), text_at(tool, "compiler"), text_at(card.at("reproduction"), "tolerance"),
                     html_table(inputs), text_at(scope, "valid_for"), text_at(scope, "not_calibrated_for"));
}

}  // namespace

std::string report_page(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw ConfigError({fmt::format("{}: there is no such run folder", folder.string())});
  const Json card = read(folder / "fit.json");
  if (text_at(card, "schema") != "tilth.card/1")
    throw ConfigError({fmt::format("{}: is missing or no parameter card", (folder / "fit.json").string())});
  try {
    return html_page("Tilth: " + card.at("soil").value("name", ""),
                     head(card) + fit_section(card) + targets_section(card, folder) +
                         known_section(card, folder) + holdout_section(card) + curves_section(folder) +
                         failures_section(card) + cost_section(card, read(folder / "timing.json")) +
                         again_section(card));
  } catch (const Json::exception& e) {
    throw ConfigError({fmt::format("{}: is no whole parameter card: {}", (folder / "fit.json").string(), e.what())});
  }
}

}  // namespace tilth
