// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/sweep_features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/steady_window.hpp"
#include "experiments/surface_profile.hpp"
#include "experiments/sweep_flow.hpp"
#include "experiments/sweep_stretch.hpp"

namespace tilth {
namespace {

enum Column : std::size_t { travel, draught, vertical, side, contacts, contact_density, forward_flow, outward_flow };

std::vector<double> column_of(const Curve& curve, std::size_t column, Window w) {
  std::vector<double> values;
  for (std::size_t k = w.begin; k < w.end; ++k) values.push_back(curve.rows[k][column]);
  return values;
}

/// Rows of the forces that are steady: inside the stretch, without what the draught says is
/// transient.
Window steady_rows(const Curve& forces, const SweepStretch& stretch) {
  const auto first = std::ranges::find_if(
      forces.rows, [&](const auto& row) { return row[travel] >= stretch.steady_from_m; });
  const auto skipped = static_cast<std::size_t>(first - forces.rows.begin());
  const std::vector<double> series = column_of(forces, draught, {skipped, forces.rows.size()});
  const Window w = steady_window(series, std::max<std::size_t>(series.size() / 24, 1));
  return {skipped + w.begin, skipped + w.end};
}

void add_forces(const Curve& forces, Window w, ExperimentResult& r) {
  const auto add = [&](const std::string& quantity, Column column) {
    const MeanWithError m = mean_with_error(column_of(forces, column, w));
    r.features.push_back({quantity + "_N", m.mean});
    r.features.push_back({quantity + "_error_N", m.standard_error});
  };
  add("draught", draught);
  add("vertical_force", vertical);
  add("side_force", side);
  r.features.push_back({"steady_begin_m", forces.rows[w.begin][travel]});
  r.features.push_back({"steady_end_m", forces.rows[w.end - 1][travel]});
  r.features.push_back({"tool_contacts", mean_with_error(column_of(forces, contacts, w)).mean});
  r.features.push_back(
      {"contact_density_per_m2", mean_with_error(column_of(forces, contact_density, w)).mean});
}

void add_flow(const Curve& forces, Window w, const SweepTillageConfig& c, ExperimentResult& r) {
  if (!c.tool_mesh.triangle.empty()) return;
  r.features.push_back(
      {"flow_angle_rad", flow_angle_rad(mean_with_error(column_of(forces, forward_flow, w)).mean,
                                        mean_with_error(column_of(forces, outward_flow, w)).mean,
                                        c.speed_m_per_s)});
}

void add_tracer_features(const std::vector<TracerMean>& means, ExperimentResult& r) {
  for (const TracerMean& m : means) {
    const std::string at = tracer_label(m.depth_m, m.lateral_m);
    r.features.push_back({"forward_displacement_m@" + at, m.mean_m.x()});
    r.features.push_back({"lateral_displacement_m@" + at, m.mean_m.y()});
    r.features.push_back({"vertical_displacement_m@" + at, m.mean_m.z()});
  }
  for (std::size_t begin = 0, end = 0; begin < means.size(); begin = end) {
    Vec3 sum_m = Vec3::Zero();
    for (end = begin; end < means.size() && means[end].depth_m == means[begin].depth_m; ++end)
      sum_m += means[end].mean_m;
    sum_m /= static_cast<double>(end - begin);
    const std::string at = fmt::format("{:g}m", means[begin].depth_m);
    r.features.push_back({"forward_displacement_m@" + at, sum_m.x()});
    r.features.push_back({"vertical_displacement_m@" + at, sum_m.z()});
  }
}

/// Tracers that the nose reached while the forces were steady.
void add_tracers(const SweepRecord& record, double steady_begin_m, ExperimentResult& r) {
  const double last_m = record.tracers.back().site_m.x();
  std::vector<Tracer> used;
  std::vector<Vec3> moved_m;
  Curve each{"tracers",
             {"tracer", "initial_depth_m", "initial_lateral_m", "initial_x_m", "forward_m",
              "lateral_m", "vertical_m"},
             {}};
  for (const Tracer& t : record.tracers) {
    if (t.site_m.x() < std::min(steady_begin_m, last_m)) continue;
    used.push_back(t);
    moved_m.push_back(tracer_displacement_m(t, record.settled_m, record.at_rest_m));
    const Vec3& d = moved_m.back();
    each.rows.push_back({static_cast<double>(used.size()), t.depth_m, t.lateral_m, t.site_m.x(),
                         d.x(), d.y(), d.z()});
  }
  const std::vector<TracerMean> means = tracer_means(used, moved_m);
  Curve summary{"tracer_means",
                {"initial_depth_m", "initial_lateral_m", "num_tracers", "forward_m", "lateral_m",
                 "vertical_m", "forward_sd_m", "lateral_sd_m", "vertical_sd_m"},
                {}};
  for (const TracerMean& m : means)
    summary.rows.push_back({m.depth_m, m.lateral_m, static_cast<double>(m.num_tracers),
                            m.mean_m.x(), m.mean_m.y(), m.mean_m.z(), m.sd_m.x(), m.sd_m.y(),
                            m.sd_m.z()});
  add_tracer_features(means, r);
  r.curves.push_back(std::move(each));
  r.curves.push_back(std::move(summary));
}

Curve profile_curve(const std::string& name, const Profile& p) {
  Curve curve{name, {"lateral_m", "height_m"}, {}};
  for (std::size_t k = 0; k < p.height_m.size(); ++k)
    curve.rows.push_back({p.lateral_m[k], p.height_m[k]});
  return curve;
}

/// Cross-section of the bed whose aggregates moved: their bulk volume over the stretch's length.
double disturbed_area_m2(const SweepTillageConfig& c, const std::vector<double>& radius_m,
                         const SweepRecord& record, double from_m, double to_m) {
  double solid_m3 = 0.0;
  for (std::size_t i = 0; i < radius_m.size(); ++i) {
    const double x_m = record.settled_m[i].x();
    if (x_m < from_m || x_m > to_m) continue;
    if ((record.at_rest_m[i] - record.settled_m[i]).norm() > c.disturbed_beyond_m)
      solid_m3 += 4.0 / 3 * std::numbers::pi * std::pow(radius_m[i], 3);
  }
  return solid_m3 / (1 - c.porosity) / (to_m - from_m);
}

void add_surface(const SweepTillageConfig& c, const std::vector<double>& radius_m,
                 const SweepRecord& record, const SweepStretch& stretch, ExperimentResult& r) {
  const ProfileFrame frame{.from_m = stretch.steady_from_m,
                           .to_m = stretch.tracers_to_m,
                           .width_m = c.bin_width_m,
                           .cell_m = 2 * c.particle_radius_m};
  const Profile before = surface_profile(record.settled_m, radius_m, frame);
  const Profile after = surface_profile(record.at_rest_m, radius_m, frame);
  Profile change = after;
  for (std::size_t k = 0; k < change.height_m.size(); ++k) change.height_m[k] -= before.height_m[k];
  const FurrowArea area = furrow_area(before, after);
  r.features.push_back({"furrow_area_m2", area.furrow_m2});
  r.features.push_back({"ridge_area_m2", area.ridge_m2});
  r.features.push_back(
      {"disturbed_area_m2", disturbed_area_m2(c, radius_m, record, frame.from_m, frame.to_m)});
  r.curves.push_back(profile_curve("surface_before", before));
  r.curves.push_back(profile_curve("surface_after", after));
  r.curves.push_back(profile_curve("furrow", change));
}

}  // namespace

Curve empty_force_curve() {
  return {"sweep_forces",
          {"travel_m", "draught_N", "vertical_N", "side_N", "contacts", "contact_density_per_m2",
           "forward_flow_m_per_s", "outward_flow_m_per_s"},
          {}};
}

void read_sweep(const SweepTillageConfig& c, const std::vector<double>& radius_m,
                const SweepRecord& record, ExperimentResult& r) {
  const SweepStretch stretch(c);
  const Window w = steady_rows(r.curves.front(), stretch);
  const double steady_begin_m = r.curves.front().rows[w.begin][travel];
  add_forces(r.curves.front(), w, r);
  add_flow(r.curves.front(), w, c, r);
  add_surface(c, radius_m, record, stretch, r);
  add_tracers(record, steady_begin_m, r);
}

}  // namespace tilth
