// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/cli/fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "calibrate/cli/curve_sample_sizes.hpp"
#include "calibrate/cli/figures.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/triaxial_figures.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth {
namespace {

/// One rerun at the fitted values.
struct Rerun {
  PlannedTest test;
  Fidelity fidelity;
  std::uint64_t seed = 0;
  ExperimentResult result;
};

std::vector<Rerun> reruns(const SoilData& soil, const SoilMaterial& material, Fidelity search,
                          Fidelity confirm, std::uint64_t first_seed, const RunContext& context) {
  std::vector<Rerun> runs;
  const auto plan = [&](Fidelity fidelity, std::uint64_t seed) {
    for (const PlannedTest& test : plan_tests(soil, fidelity))
      runs.push_back({test, fidelity, seed, {}});
  };
  plan(confirm, first_seed);
  plan(search, first_seed);
  plan(search, first_seed + 1);
  std::vector<TestRun> wanted;
  for (Rerun& run : runs) {
    set_packing_seed(run.test.config, run.seed);
    wanted.push_back({run.test.config, run.test.condition_id, material});
  }
  std::vector<ExperimentResult> results = run_tests(wanted, context);
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].result = std::move(results[k]);
  return runs;
}

/// Targets that are a stress on the figure's axis; moduli and angles are in the targets figure.
std::vector<FigureMark> stress_marks(const SoilData& soil, const PlannedTest& test,
                                     const std::string& curve_name) {
  std::vector<FigureMark> marks;
  for (const PlannedTest::Answer& a : test.answers) {
    const SoilTarget& t = soil.targets[a.target];
    const bool stress = t.observable_id.find("stress_Pa") != std::string::npos;
    const std::size_t at = a.feature.find('@');
    const bool here =
        at == std::string::npos || curve_name.ends_with("_" + a.feature.substr(at + 1) + "Pa");
    if (!stress || !here) continue;
    const double factor = t.sigma_kind == SigmaKind::log ? std::exp(t.sigma) : 0.0;
    marks.push_back({fmt::format("{} ({}{})", t.observable_id, to_string(t.origin.provenance),
                                 t.holdout ? ", held out" : ""),
                     t.value, factor > 0 ? t.value / factor : t.value - sigma_of(t),
                     factor > 0 ? t.value * factor : t.value + sigma_of(t)});
  }
  return marks;
}

std::string kind_of(const Rerun& run, Fidelity first) {
  return fmt::format("simulated, {} specimen{}", name_of(run.fidelity),
                     run.fidelity == first ? "" : "s");
}

/// Every condition of a triaxial series has figures of its own, with its measured curve.
void draw_triaxial_tests(const SoilData& soil, const std::vector<Rerun>& runs,
                         const std::filesystem::path& folder, FitCurves& out) {
  for (const TestCondition& condition : soil.conditions) {
    const auto pressure = condition.number("cell_pressure_Pa");
    if (!pressure) continue;
    const std::string name =
        "triaxial_" + triaxial_state_label(*pressure, condition.number("relative_density"));
    std::vector<SimulatedTriaxial> simulated;
    for (const Rerun& r : runs)
      for (const Curve& c : r.result.curves)
        if (c.name == name)
          simulated.push_back({kind_of(r, runs.front().fidelity),
                               r.fidelity == runs.front().fidelity ? 1 : 0, c});
    if (simulated.empty()) continue;
    if (const MeasuredCurve* measured = soil.curve("drained_triaxial", condition.id))
      std::ranges::copy(curve_sample_sizes(*measured, simulated.front().curve),
                        std::back_inserter(out.sample_sizes));
    const bool holdout = std::ranges::any_of(soil.targets, [&](const SoilTarget& t) {
      return t.condition_id == condition.id && t.holdout;
    });
    for (const std::string& why :
         draw_triaxial(soil, condition.id, holdout, simulated,
                       folder / "figures" / ("drained_triaxial_" + condition.id)))
      out.missing.push_back(why);
  }
}

void draw_tests(const SoilData& soil, const std::vector<Rerun>& runs,
                const std::filesystem::path& folder, std::vector<std::string>& missing) {
  for (const Rerun& first : runs) {
    if (first.fidelity != runs.front().fidelity) continue;
    if (std::holds_alternative<DrainedTriaxialConfig>(first.test.config)) continue;
    for (const Curve& curve : first.result.curves) {
      const std::string id = test_id(first.test.config);
      const CurveStyle style = curve_style(id);
      CurveFigure figure{fmt::format("{}: {}, {} (model at the fitted values)", soil.name, id,
                                     curve.name),
                         style.x_label, style.y_label, style.x_column, style.y_column,
                         style.x_scale, style.y_scale, true, {}, {}};
      for (const Rerun& r : runs) {
        if (id != test_id(r.test.config) || r.test.condition_id != first.test.condition_id) continue;
        for (const Curve& c : r.result.curves)
          if (c.name == curve.name)
            figure.series.push_back(
                {kind_of(r, first.fidelity), r.fidelity == first.fidelity ? 1 : 0, c});
      }
      figure.marks = stress_marks(soil, first.test, curve.name);
      const std::string name = fmt::format("{}_{}_{}.svg", id, first.test.condition_id, curve.name);
      if (const std::string why = draw_curves(figure, folder / "figures" / name); !why.empty())
        missing.push_back(fmt::format("no figure {}: {}", name, why));
    }
  }
}

/// "test/observable/condition" as "observable, condition" over "test, provenance: target 1.3e6, simulated 2e6".
TargetRow target_row(const TargetResult& t, bool holdout) {
  const std::size_t slash = t.name.find('/');
  const std::size_t end = t.name.find('/', slash + 1);
  return {fmt::format("{}, {}\n{}: {:.3g}, simulated {:.3g}",
                      t.name.substr(slash + 1, end - slash - 1), t.name.substr(end + 1),
                      to_string(t.provenance), t.value, t.simulated),
          t.value, t.simulated, t.residual,
          t.sigma_total > 0 ? t.seed_sd / t.sigma_total : 0.0, holdout};
}

}  // namespace

CurveStyle curve_style(const std::string& test_id) {
  if (test_id == "direct_shear")
    return {"shear displacement (mm)", "shear stress (kPa)", 0, 1, 1e3, 1e-3};
  if (test_id == "interface_shear")
    return {"travel of the steel (mm)", "interface stress (kPa)", 0, 1, 1e3, 1e-3};
  if (test_id == "direct_tension")
    return {"axial strain (%), extension", "tensile stress (kPa)", 0, 1, 1e2, 1e-3};
  return {"axial strain (%)", "axial stress (kPa)", 0, 1, 1e2, 1e-3};
}

FitCurves write_curves_and_figures(const SoilData& soil, const FitSummary& summary, Fidelity search,
                                   Fidelity confirm, std::uint64_t first_seed,
                                   const RunContext& context, const std::filesystem::path& folder) {
  FitCurves out;
  const std::vector<Rerun> runs = reruns(soil, material_of(soil, summary.values()), search, confirm,
                                         first_seed, context);
  for (const Rerun& r : runs) {
    const std::string stem = fmt::format("{}_{}_{}_seed{}", test_id(r.test.config),
                                         r.test.condition_id, name_of(r.fidelity), r.seed);
    if (r.result.status != RunStatus::completed)
      out.missing.push_back(fmt::format("no curve {}: {}", stem, r.result.message));
    for (const Curve& curve : r.result.curves)
      write_file(folder / "curves" / fmt::format("{}_{}.csv", stem, curve.name), curve_csv(curve));
  }
  draw_tests(soil, runs, folder, out.missing);
  draw_triaxial_tests(soil, runs, folder, out);
  std::vector<TargetRow> rows;
  for (const TargetResult& t : summary.targets) rows.push_back(target_row(t, false));
  for (const TargetResult& t : summary.holdouts) rows.push_back(target_row(t, true));
  const std::string why = draw_targets(fmt::format("{}: targets against simulation\n{}", soil.name,
                                                   provenance_sentence(soil)),
                                       rows, folder / "figures" / "targets.svg");
  if (!why.empty()) out.missing.push_back("no figure targets.svg: " + why);
  return out;
}

}  // namespace tilth
