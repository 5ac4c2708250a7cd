// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/diagnose/tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace tilth::scoreboard {
namespace {

using Filter = std::function<bool(const Score&)>;

bool is_hidden(const Score& s, const std::string& id) {
  return std::ranges::find(s.hidden.effects, id, &ChosenEffect::id) != s.hidden.effects.end();
}

/// Names that are not hidden. A struck candidate cannot be named; what is named in its stead is wrong.
int num_wrong(const Score& s) {
  return static_cast<int>(std::ranges::count_if(s.names, [&](const std::string& n) { return !is_hidden(s, n); }));
}
bool is_right(const Score& s) { return !s.names.empty() && num_wrong(s) == 0 && s.names.size() == s.hidden.effects.size(); }

/// The answer does not exclude the truth.
bool holds_truth(const Score& s) {
  if (!s.names.empty()) return is_right(s);
  if (s.hidden.kind == CaseKind::outside) return s.set_holds_other || s.verdict == "outside_catalogue";
  if (s.hidden.effects.empty()) return s.set_holds_none || s.verdict == "none" || s.verdict == "inconclusive";
  return std::ranges::all_of(s.hidden.effects, [&](const ChosenEffect& e) { return std::ranges::find(s.set, e.id) != s.set.end(); });
}

/// "12 of 60 (20 %; 12-32 %)": Wilson's 95 % interval, J. Am. Stat. Assoc. 22 (1927) 209.
std::string share(int k, int n) {
  if (n == 0) return "none";
  constexpr double z = 1.959963984540054;
  const double p = static_cast<double>(k) / n, w = z * z / n;
  const double middle = (p + w / 2) / (1 + w), half = z / (1 + w) * std::sqrt(p * (1 - p) / n + w / (4 * n));
  return fmt::format("{} of {} ({:.0f} %; {:.0f}-{:.0f} %)", k, n, 100 * p, 100 * std::max(0.0, middle - half),
                     100 * std::min(1.0, middle + half));
}

double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double size_factor(const Score& s) {  ///< of a single, over the typical size
  for (const Effect& e : effect_catalogue())
    for (const EffectParameter& p : e.parameters)
      if (!s.hidden.effects.empty() && p.name == s.hidden.effects.front().parameter)
        return std::abs((s.hidden.effects.front().value - p.null_value) / (p.typical - p.null_value));
  return std::nan("");
}

double closure_of(double before, double after) { return before > 0.0 ? 1.0 - after / before : std::nan(""); }

struct Tally {
  const std::vector<Score>& scores;
  int count(const Filter& of, const Filter& that) const {
    return static_cast<int>(std::ranges::count_if(scores, [&](const Score& s) { return !s.is_lost && of(s) && that(s); }));
  }
  std::string line(const std::string& words, const std::string& goal, const Filter& of, const Filter& that) const {
    return fmt::format("| {} | {} | {} |\n", words, goal, share(count(of, that), count(of, [](const Score&) { return true; })));
  }
};

Filter of_kind(CaseKind kind) {
  return [kind](const Score& s) { return s.hidden.kind == kind; };
}

}  // namespace

std::string csv_heading() {
  return "case,kind,hidden,changed,struck,verdict,names,set,set_holds_none,set_holds_other,posterior,can_see,is_separable,nearest,"
         "lambda,rho,size_ratio,size_inside,gap_before,gap_said,gap_oracle,held_out_before,held_out_said,held_out_oracle\n";
}

std::string csv_line(const Score& s) {
  std::vector<std::string> hidden, changed;
  for (const ChosenEffect& e : s.hidden.effects) hidden.push_back(fmt::format("{}={:.4g}", e.id, e.value));
  for (const auto& [name, value] : s.hidden.model_changes) changed.push_back(fmt::format("{}={:g}", name, value));
  return fmt::format("{},{},{},{},{},{},{},{},{:d},{:d},{:.3f},{:d},{:d},{},{:.1f},{:.2f},{:.3f},{:d},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n",
                     s.hidden.id, name_of(s.hidden.kind), fmt::join(hidden, ";"), fmt::join(changed, ";"), s.hidden.struck_candidate,
                     s.is_lost ? "lost" : s.verdict, fmt::join(s.names, ";"), fmt::join(s.set, ";"), s.set_holds_none,
                     s.set_holds_other, s.posterior, s.can_see, s.is_separable, s.nearest, s.lambda, s.rho, s.size_ratio,
                     s.size_inside, s.before, s.said, s.oracle, s.before_held_out, s.said_held_out, s.oracle_held_out);
}

std::string tables(const std::vector<Score>& scores) {
  const Tally t{scores};
  const Filter any = [](const Score&) { return true; };
  std::string text = "| hidden | cases | right name | wrong name | set with the truth | set without it | none, inconclusive | outside | lost |\n"
                     "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const CaseKind kind : {CaseKind::single, CaseKind::nothing, CaseKind::trap, CaseKind::outside, CaseKind::pair}) {
    const Filter of = of_kind(kind);
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name_of(kind), t.count(of, any), t.count(of, is_right),
        t.count(of, [](const Score& s) { return num_wrong(s) > 0; }),
        t.count(of, [](const Score& s) { return s.verdict == "set" && holds_truth(s); }),
        t.count(of, [](const Score& s) { return s.verdict == "set" && !holds_truth(s); }),
        t.count(of, [](const Score& s) { return s.verdict == "none" || s.verdict == "inconclusive"; }),
        t.count(of, [](const Score& s) { return s.verdict == "outside_catalogue"; }),
        std::ranges::count_if(scores, [&](const Score& s) { return s.is_lost && of(s); }));
  }
  const auto single = of_kind(CaseKind::single);
  const auto is_wrong = [](const Score& s) { return num_wrong(s) > 0; };
  const auto is_soil_name = [](const Score& s) { return !s.names.empty() && num_wrong(s) > 0; };
  const Filter seen = [&](const Score& s) { return single(s) && s.can_see && s.is_separable; };
  text += "\n| figure | goal | measured (95 % interval) |\n| --- | --- | --- |\n";
  text += t.line("false name, nothing hidden", "0 of 60", of_kind(CaseKind::nothing), [](const Score& s) { return !s.names.empty(); });
  text += t.line("wrong name, one effect hidden", "at most 5 %", single, is_wrong);
  text += t.line("right name, size of 0.7 to 1.4 typical, separable by the measured map", "65 %",
                 [&](const Score& s) { return seen(s) && size_factor(s) >= 0.7 && size_factor(s) <= 1.4; }, is_right);
  text += t.line("right name, any size, separable by the measured map", "", seen, is_right);
  text += t.line("right name, any size, all", "", single, is_right);
  text += t.line("answer holds the truth (name, or 95 % set)", "90 %", single, [](const Score& s) {
    return is_right(s) || (s.verdict == "set" && holds_truth(s)) || ((s.verdict == "none" || s.verdict == "inconclusive") && !s.can_see);
  });
  text += t.line("a soil effect named for an artefact", "0", of_kind(CaseKind::trap), is_soil_name);
  text += t.line("a name, truth outside the catalogue", "at most 15 %", of_kind(CaseKind::outside), [](const Score& s) { return !s.names.empty(); });
  text += t.line("pairs: a wrong name among the names", "at most 10 %", of_kind(CaseKind::pair), is_wrong);
  text += t.line("pairs: at least one of the two named", "", of_kind(CaseKind::pair), [](const Score& s) {
    return std::ranges::any_of(s.names, [&](const std::string& n) { return is_hidden(s, n); });
  });
  std::vector<double> errors, closed, oracle, ratio;
  int num_sizes = 0, num_inside = 0;
  for (const Score& s : scores) {
    if (s.is_lost || !single(s)) continue;
    if (is_right(s)) {
      errors.push_back(std::abs(s.size_ratio - 1.0));
      ++num_sizes;
      num_inside += s.size_inside;
      closed.push_back(closure_of(s.before_held_out, s.said_held_out));
    }
    // where there is a gap on held-out data to close
    if (s.before_held_out > 0.02 && std::isfinite(s.oracle_held_out)) {
      const double best = closure_of(s.before_held_out, s.oracle_held_out);
      const double said = s.names.empty() ? 0.0 : closure_of(s.before_held_out, s.said_held_out);
      oracle.push_back(best);
      if (best > 0.05 && std::isfinite(said)) ratio.push_back(said / best);
    }
  }
  text += fmt::format("| median error of the size, right names | 25 % | {:.0f} % of {} |\n", 100 * median(errors), num_sizes);
  text += fmt::format("| 90 % interval holds the size | | {} |\n", share(num_inside, num_sizes));
  text += fmt::format("| held-out gap closed, right names, median | | {:.0f} % of {} |\n", 100 * median(closed), closed.size());
  text += fmt::format("| held-out gap closed over what the hidden effect itself closes, singles with a gap, median | 60 % | {:.0f} % of {} (the hidden effect closes {:.0f} %) |\n",
                      100 * median(ratio), ratio.size(), 100 * median(oracle));

  text += "\n| hidden effect | cases | right | wrong | set with it | else | median abs(rho) to the nearest, and which |\n| --- | ---: | ---: | ---: | ---: | ---: | --- |\n";
  std::map<std::string, std::vector<const Score*>> by_effect;
  for (const Score& s : scores)
    if (!s.is_lost && single(s)) by_effect[s.hidden.effects.front().id].push_back(&s);
  for (const auto& [id, list] : by_effect) {
    int right = 0, wrong = 0, set = 0;
    std::vector<double> rhos;
    for (const Score* s : list) {
      if (is_right(*s)) ++right;
      else if (num_wrong(*s) > 0) ++wrong;
      else if (s->verdict == "set" && holds_truth(*s)) ++set;
      rhos.push_back(s->rho);
    }
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {:.2f} {} |\n", id, list.size(), right, wrong, set,
                        static_cast<int>(list.size()) - right - wrong - set, median(rhos), list.front()->nearest);
  }
  text += "\nWrong names:\n\n| case | kind | hidden | said | probability | held out before, after |\n| --- | --- | --- | --- | ---: | --- |\n";
  for (const Score& s : scores) {
    if (s.is_lost || num_wrong(s) == 0) continue;
    std::vector<std::string> hidden;
    for (const ChosenEffect& e : s.hidden.effects) hidden.push_back(fmt::format("{} {:.3g}", e.id, e.value));
    for (const auto& [name, value] : s.hidden.model_changes) hidden.push_back(fmt::format("{} {:g}", name, value));
    text += fmt::format("| {} | {} | {} | {} {} | {:.2f} | {:.3f}, {:.3f} |\n", s.hidden.id, name_of(s.hidden.kind),
                        fmt::join(hidden, ", "), s.verdict, fmt::join(s.names, ", "), s.posterior, s.before_held_out, s.said_held_out);
  }
  return text;
}

}  // namespace tilth::scoreboard
