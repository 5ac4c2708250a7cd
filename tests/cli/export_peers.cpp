// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The decks run in the codes they are for, where installed, and give our curves (docs/export.md).
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>

#include "calibrate/cli/export_decks.hpp"
#include "calibrate/cli/run_folder.hpp"
#include "dem_core/step.hpp"
#include "experiments/curve_features.hpp"
#include "tests/cli/export_fixture.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;
using export_test::Folder;

namespace {

constexpr std::size_t strain = 0, stress = 1;

bool installed(const std::string& program) {
  if (std::system(("command -v " + program + " > /dev/null").c_str()) == 0) return true;
  WARN(program << " is not installed: nothing compared");
  return false;
}

/// Numbers of a table whose other lines are headings.
Curve read_table(const std::filesystem::path& path, std::size_t first_column) {
  std::ifstream in(path);
  Curve curve{"peer", {"axial_strain", "axial_stress_Pa"}, {}};
  for (std::string line; std::getline(in, line);) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream numbers(line);
    std::vector<double> row;
    for (double v = 0; numbers >> v;) row.push_back(v);
    if (row.size() >= first_column + 2)
      curve.rows.push_back({row[first_column], row[first_column + 1]});
  }
  return curve;
}

Curve run_deck(const std::vector<ExportFile>& files, const std::filesystem::path& folder,
               const std::string& command, const std::string& curve, std::size_t first_column) {
  for (const ExportFile& f : files) write_file(folder / f.name, f.text);
  const std::string line =
      fmt::format("cd '{}' && {} > log 2>&1 < /dev/null", folder.string(), command);
  if (std::system(line.c_str()) != 0) FAIL(line + ":\n" + Folder::read(folder / "log"));
  return read_table(folder / curve, first_column);
}

const std::string yade = "yade -n -x -j1 unconfined_compression.py";
const std::string lammps = "lmp -in confined_compression.in";
const std::string liggghts = "liggghts -in confined_compression.in";

struct Peers {
  Folder folder{"peers"};
  ExportSource source = read_export_source(folder.card());
  PackingStore packings{default_packing_folder()};

  Curve run_yade(const ExportSpecimen& s) {
    return run_deck(yade_files(source, s), folder.path() / "yade", yade, "curve.csv", 0);
  }
  Curve run_lammps(const ExportSpecimen& s) {
    return run_deck(lammps_files(source, s), folder.path() / "lammps", lammps, "curve.txt", 1);
  }
  Curve run_liggghts(const ExportSpecimen& s) {
    return run_deck(liggghts_files(source, s), folder.path() / "liggghts", liggghts, "curve.txt",
                    1);
  }
};

/// Three spheres, one upon the other, between the platens.
ExportSpecimen column(const SoilMaterial& material) {
  ExportSpecimen s;
  s.radius_m = {0.9e-3, 1.0e-3, 1.1e-3};
  s.position_m = {{0, 0, 0.9e-3}, {0, 0, 2.8e-3}, {0, 0, 4.9e-3}};
  s.mean_radius_m = 1e-3;
  s.container_radius_m = 3e-3;
  s.height_m = 6e-3;
  s.platen_speed_m_per_s = 1e-3;
  s.dt_s = 2e-6;
  s.final_strain = 2e-3;
  s.bonds = {parallel_bond(0, 1, 0.9e-3, 1.0e-3, 1.9e-3),
             parallel_bond(1, 2, 1e-3, 1.1e-3, 2.1e-3)};
  s.packing = "column";
  s.reference = compress(loose_model(s, material), s, 1e9, s.final_strain);
  return s;
}

/// Springs in series: k = (sum 1/k_i)^-1 as stress over strain of the column.
double column_modulus_Pa(const std::vector<double>& k_N_per_m, const ExportSpecimen& s) {
  double flexibility = 0;
  for (const double k : k_N_per_m) flexibility += 1 / k;
  return s.height_m / flexibility /
         (3.14159265358979 * s.container_radius_m * s.container_radius_m);
}

/// Slope between half and all of the strain.
double late_slope_Pa(const Curve& c) {
  const auto& a = c.rows[c.rows.size() / 2];
  const auto& b = c.rows.back();
  return (b[stress] - a[stress]) / (b[strain] - a[strain]);
}

void report(const std::string& what, double ours, double theirs) {
  WARN(fmt::format("{}: ours {:.6g}, deck {:.6g}, deck / ours - 1 = {:+.3g}", what, ours, theirs,
                   theirs / ours - 1));
}

double loading_modulus_Pa(const Curve& c, double from_Pa, double to_Pa) {
  const double a = first_crossing(c, strain, stress, from_Pa, 0, c.rows.size());
  const double b = first_crossing(c, strain, stress, to_Pa, 0, c.rows.size());
  return (to_Pa - from_Pa) / (b - a);
}

}  // namespace

TEST_CASE("Export: a column of three spheres is as stiff in each deck as in our core",
          "[cli][export][slow]") {
  Peers peers;
  SoilMaterial& m = peers.source.set.material;
  m.contact_modulus_Pa = m.bond.modulus_Pa = 20e6;
  m.bond.tensile_strength_Pa = m.bond.cohesion_Pa = 1e9;
  m.bond.radius_multiplier = 1;
  const ExportSpecimen s = column(m);
  const double pi_E = 3.14159265358979 * 20e6;
  const std::vector<double> loose = {pi_E * 0.9e-3, pi_E * 0.81e-6 / 1.9e-3, pi_E * 1e-6 / 2.1e-3,
                                     pi_E * 1.1e-3};
  const double ours = late_slope_Pa(s.reference);
  // 1e-5: the two stresses differ by the inertia of a column closing at 1 mm/s.
  CHECK_THAT(ours, WithinRel(column_modulus_Pa(loose, s), 1e-5));
  if (installed("lmp")) {
    const double theirs = late_slope_Pa(peers.run_lammps(s));
    report("column in LAMMPS, Pa", ours, theirs);
    CHECK_THAT(theirs, WithinRel(ours, 1e-5));
  }
  if (installed("liggghts")) {
    const double theirs = late_slope_Pa(peers.run_liggghts(s));
    report("column in LIGGGHTS, Pa", ours, theirs);
    CHECK_THAT(theirs, WithinRel(ours, 1e-5));
  }
  if (installed("yade")) {
    Model bonded = loose_model(s, m);
    bonded.bonds = s.bonds;
    const double ours_bonded = late_slope_Pa(compress(bonded, s, 1e9, s.final_strain));
    const double theirs = late_slope_Pa(peers.run_yade(s));
    CHECK_THAT(
        ours_bonded,
        WithinRel(column_modulus_Pa({loose[0], 2 * loose[1], 2 * loose[2], loose[3]}, s), 1e-5));
    report("bonded column in YADE, Pa", ours_bonded, theirs);
    CHECK_THAT(theirs, WithinRel(ours_bonded, 1e-3));
  }
}

TEST_CASE("Export: 500 bonded spheres break in YADE at our peak", "[cli][export][slow]") {
  if (!installed("yade")) return;
  Peers peers;
  const ExportSpecimen s = bonded_specimen(peers.source.set.material, 500, 1, peers.packings);
  const Curve theirs = peers.run_yade(s);
  const std::size_t a = row_of_largest(s.reference, stress), b = row_of_largest(theirs, stress);
  const double modulus_a = secant_at_share(s.reference, strain, stress, a, 0.5);
  const double modulus_b = secant_at_share(theirs, strain, stress, b, 0.5);
  report("secant modulus in YADE, Pa", modulus_a, modulus_b);
  report("peak in YADE, Pa", s.reference.rows[a][stress], theirs.rows[b][stress]);
  report("strain at peak in YADE", s.reference.rows[a][strain], theirs.rows[b][strain]);
  // Measured: modulus 0.1 %, peak 1.5 % (docs/export.md); breakage amplifies the lag of the watch.
  CHECK_THAT(modulus_b, WithinRel(modulus_a, 0.005));
  CHECK_THAT(theirs.rows[b][stress], WithinRel(s.reference.rows[a][stress], 0.03));
}

TEST_CASE("Export: 500 loose spheres compress in LAMMPS and LIGGGHTS as in our core",
          "[cli][export][slow]") {
  Peers peers;
  const ExportSpecimen s = loose_specimen(peers.source.set.material, 500, 1, peers.packings);
  const double ours = loading_modulus_Pa(s.reference, 25e3, 75e3);
  const auto compare = [&](const std::string& code, const Curve& theirs) {
    report("constrained modulus in " + code + ", Pa", ours, loading_modulus_Pa(theirs, 25e3, 75e3));
    report("strain at 75 kPa in " + code,
           first_crossing(s.reference, strain, stress, 75e3, 0, s.reference.rows.size()),
           first_crossing(theirs, strain, stress, 75e3, 0, theirs.rows.size()));
    // Measured: 0.3 % (docs/export.md), as much as a halved step changes our own; three times that.
    CHECK_THAT(loading_modulus_Pa(theirs, 25e3, 75e3), WithinRel(ours, 0.015));
  };
  if (installed("lmp")) compare("LAMMPS", peers.run_lammps(s));
  if (installed("liggghts")) compare("LIGGGHTS", peers.run_liggghts(s));
}
