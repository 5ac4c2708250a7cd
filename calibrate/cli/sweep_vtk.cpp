// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "calibrate/cli/run_folder.hpp"
#include "calibrate/cli/sweep_views.hpp"

namespace tilth {
namespace {

std::vector<double> bonds_left(const Specimen& s) {
  std::vector<double> count(s.model.radius_m.size(), 0.0);
  for (std::size_t b = 0; b < s.model.bonds.size(); ++b) {
    if (!s.state.bond_holds(static_cast<int>(b))) continue;
    ++count[static_cast<std::size_t>(s.model.bonds[b].i)];
    ++count[static_cast<std::size_t>(s.model.bonds[b].j)];
  }
  return count;
}

}  // namespace

BedView view_of(const SweepFrame& frame) {
  const Specimen& s = frame.specimen;
  BedView view{.radius_m = s.model.radius_m,
               .tool = s.model.tools.front().mesh,
               .surface_m = frame.surface_m};
  for (std::size_t i = 0; i < frame.settled_m.size(); ++i) {
    view.position_m.push_back(s.state.position_m(static_cast<int>(i)));
    view.displacement_m.push_back(view.position_m.back() - frame.settled_m[i]);
  }
  for (Vec3& v : view.tool.vertex_m)
    v = s.state.tool_position_m(0) + s.state.tool_orientation(0) * v;
  for (const Tracer& t : frame.tracers) {
    view.tracer_m.push_back(t.site_m + tracer_displacement_m(t, frame.settled_m, view.position_m));
    view.tracer_depth_m.push_back(t.depth_m);
  }
  return view;
}

void SweepVtk::write(const std::string& what, double time_s, const std::string& text,
                     std::vector<VtkStep>& steps) const {
  steps.push_back({time_s, fmt::format("{}_{:04}.vtp", what, steps.size())});
  write_file(folder_ / steps.back().file, text);
  write_file(folder_ / (what + ".pvd"), pvd_series(steps));
}

void SweepVtk::add(const SweepFrame& frame) {
  const BedView view = view_of(frame);
  write("particles", frame.time_s,
        vtp_points(view.position_m,
                   {{"radius_m", view.radius_m}, {"bonds_left", bonds_left(frame.specimen)}},
                   {{"displacement_m", view.displacement_m}}),
        particles_);
  write("tool", frame.time_s, vtp_mesh(view.tool), tool_);
  std::vector<Vec3> moved_m;
  std::vector<double> lateral_m;
  for (std::size_t k = 0; k < frame.tracers.size(); ++k) {
    moved_m.push_back(view.tracer_m[k] - frame.tracers[k].site_m);
    lateral_m.push_back(frame.tracers[k].lateral_m);
  }
  write("tracers", frame.time_s,
        vtp_points(view.tracer_m,
                   {{"initial_depth_m", view.tracer_depth_m}, {"initial_lateral_m", lateral_m}},
                   {{"displacement_m", moved_m}}),
        tracers_);
}

}  // namespace tilth
