// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// `calibrate export`: tables and decks say what the card says, in the other code's formulas.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calibrate/cli/command_export.hpp"
#include "calibrate/cli/export_decks.hpp"
#include "calibrate/cli/export_template.hpp"
#include "calibrate/cli/program.hpp"
#include "calibrate/config_error.hpp"
#include "tests/cli/export_fixture.hpp"

using namespace tilth;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;
using export_test::Folder;

namespace {

constexpr double pi = std::numbers::pi;
// Numbers are written with the shortest text that reads back exactly; the formulas agree to
// rounding.
constexpr double rounding = 1e-12;

/// Runs the program as from a shell and returns exit code, standard output and standard error.
struct Said {
  int code = 0;
  std::string out, err;
};

Said run(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"calibrate", "export"};
  for (const std::string& a : arguments) argv.push_back(a.c_str());
  std::ostringstream out, err;
  std::streambuf* old_out = std::cout.rdbuf(out.rdbuf());
  std::streambuf* old_err = std::cerr.rdbuf(err.rdbuf());
  const int code = run_program(static_cast<int>(argv.size()), argv.data());
  std::cout.rdbuf(old_out);
  std::cerr.rdbuf(old_err);
  return {code, out.str(), err.str()};
}

const std::string& file(const std::vector<ExportFile>& files, const std::string& name) {
  for (const ExportFile& f : files)
    if (f.name == name) return f.text;
  throw std::runtime_error("no file " + name);
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> all;
  for (std::string w; in >> w;) all.push_back(w);
  return all;
}

std::vector<std::string> lines_with(const std::string& text, const std::string& start) {
  std::istringstream in(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(in, line);)
    if (line.rfind(start, 0) == 0) found.push_back(line);
  return found;
}

/// Spheres of a data file: type, diameter, density, x, y, z.
std::vector<std::vector<double>> data_rows(const std::string& text) {
  std::istringstream in(text.substr(text.find("Atoms\n\n") + 7));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<double> row;
    for (const std::string& w : words(line)) row.push_back(std::stod(w));
    rows.emplace_back(row.begin() + 1, row.end());
  }
  return rows;
}

/// Mean radius of each type, from the data file alone.
std::map<int, double> class_radius_m(const std::string& data) {
  std::map<int, std::pair<double, int>> sums;
  for (const auto& row : data_rows(data)) {
    sums[static_cast<int>(row[0])].first += row[1] / 2;
    ++sums[static_cast<int>(row[0])].second;
  }
  std::map<int, double> radius;
  for (const auto& [type, sum] : sums) radius[type] = sum.first / sum.second;
  return radius;
}

/// 2 zeta sqrt(k / m) of e = 0.3, written out.
double gamma_per_s(double k_N_per_m, double mass_kg) {
  const double log_e = std::log(0.3);
  return 2 * -log_e / std::sqrt(pi * pi + log_e * log_e) * std::sqrt(k_N_per_m / mass_kg);
}

double mass_kg(double r_m) { return 2500 * 4.0 / 3.0 * pi * r_m * r_m * r_m; }

struct Exported {
  Folder folder{"decks"};
  ExportSource source = read_export_source(folder.card());
  PackingStore packings;
};

}  // namespace

TEST_CASE("Export: the csv holds every value with unit, interval, role and verdict",
          "[cli][export]") {
  Folder folder("csv");
  const Said said = run({folder.card().string(), "--format", "csv"});
  REQUIRE(said.code == 0);
  CHECK_THAT(said.out, Contains("\nname,value,unit,lo95,hi95,role,verdict\n"));
  CHECK_THAT(said.out,
             Contains("\nbond_modulus_Pa,4000000,Pa,3000000,5000000,calibrated,identified\n"));
  CHECK_THAT(said.out, Contains("\nfriction,0.45,1,,,calibrated-weak,flat\n"));
  CHECK_THAT(said.out, Contains("\nbond_friction_angle_rad,0.35,rad,,,not varied,\n"));
  CHECK_THAT(said.out, Contains("\ngrain_density_kg_per_m3,2500,kg/m^3,,,not varied,\n"));
  for (const char* part : {"# Fit: soil test_loam, seed 17, status converged",
                           "# Provenance: measured targets: 1 of 2 (50 %)", "# PREVIEW",
                           "# Warning: friction is not fixed", "# Not calibrated for: draught"})
    CHECK_THAT(said.out, Contains(part));
}

TEST_CASE("Export: the json says the same, on standard output or in a folder", "[cli][export]") {
  Folder folder("json");
  const Said said = run({folder.path().string()});  // a run folder will do; json is the default
  REQUIRE(said.code == 0);
  const auto json = nlohmann::json::parse(said.out);
  CHECK(json["schema"] == "tilth.export/1");
  CHECK(json["seed"] == 17);
  CHECK(json["preview"] == true);
  CHECK(json["parameters"].size() == 15);
  CHECK(json["parameters"][0]["hi95"] == 5e6);
  CHECK(json["parameters"][1]["lo95"].is_null());
  const std::filesystem::path out = folder.path() / "out";
  REQUIRE(run({folder.card().string(), "--out", out.string()}).code == 0);
  CHECK(Folder::read(out / "parameters.json") == said.out);
}

TEST_CASE("Export: LAMMPS stiffness and dashpots recompute from the classes of the data file",
          "[cli][export]") {
  Exported e;
  const auto files =
      lammps_files(e.source, loose_specimen(e.source.set.material, 60, 3, e.packings));
  const std::string& deck = file(files, "confined_compression.in");
  const auto radius = class_radius_m(file(files, "spheres.data"));
  int num_checked = 0;
  for (const std::string& line : lines_with(deck, "pair_coeff")) {
    const auto w = words(line);
    const auto a = radius.find(std::stoi(w[1]));
    const auto b = radius.find(std::stoi(w[2]));
    if (a == radius.end() || b == radius.end()) continue;  // an empty class
    const double least = std::min(a->second, b->second);
    const double k = 3e6 * pi * least * least / (a->second + b->second);
    const double ma = mass_kg(a->second), mb = mass_kg(b->second);
    CHECK_THAT(std::stod(w[4]), WithinRel(k, rounding));
    CHECK_THAT(std::stod(w[5]), WithinRel(gamma_per_s(k, ma * mb / (ma + mb)), rounding));
    CHECK_THAT(std::stod(w[8]), WithinRel(k / 2.5, rounding));
    CHECK(w[10] == "0.45");
    ++num_checked;
  }
  CHECK(num_checked > 30);
  for (const auto& [type, r] : radius) {
    const auto w =
        words(lines_with(deck, "fix             lid" + std::to_string(type) + " ").at(0));
    CHECK_THAT(std::stod(w[6]), WithinRel(3e6 * pi * r, rounding));
    CHECK_THAT(std::stod(w[7]), WithinRel(gamma_per_s(3e6 * pi * r, mass_kg(r)), rounding));
    CHECK_THAT(std::stod(w[10]), WithinRel(3e6 * pi * r / 2.5, rounding));
    CHECK(w[12] == "0.1");
  }
}

TEST_CASE("Export: the spheres of LAMMPS and LIGGGHTS begin without overlap, and just so",
          "[cli][export]") {
  Exported e;
  const ExportSpecimen s = loose_specimen(e.source.set.material, 60, 3, e.packings);
  double nearest = 2.0;  // distance over touching distance
  for (std::size_t i = 0; i < s.radius_m.size(); ++i) {
    const Vec3& x = s.position_m[i];
    nearest = std::min({nearest, x.z() / s.radius_m[i], (s.height_m - x.z()) / s.radius_m[i],
                        (s.container_radius_m - std::hypot(x.x(), x.y())) / s.radius_m[i]});
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, (x - s.position_m[j]).norm() / (s.radius_m[i] + s.radius_m[j]));
  }
  CHECK_THAT(nearest, WithinRel(1.0, rounding));
  CHECK(s.radius_factor < 1);
  CHECK(s.reference.rows.back()[1] >= 100e3);  // ended at the stress of the oedometer
}

TEST_CASE("Export: the matrices of LIGGGHTS hold the numbers of LAMMPS, and the walls last",
          "[cli][export]") {
  Exported e;
  const ExportSpecimen s = loose_specimen(e.source.set.material, 60, 3, e.packings);
  const std::string lammps = file(lammps_files(e.source, s), "confined_compression.in");
  const std::string deck = file(liggghts_files(e.source, s), "confined_compression.in");
  const auto matrix = [&](const std::string& fix) {
    auto w = words(lines_with(deck, "fix             " + fix + " all property").at(0));
    return std::vector<std::string>(w.begin() + 7, w.end());
  };
  const auto kn = matrix("p1"), kt = matrix("p2"), gn = matrix("p3"), gt = matrix("p4"),
             mu = matrix("p5");
  const std::size_t n = 13;  // 12 classes and the walls
  for (const auto& m : {kn, kt, gn, gt, mu}) REQUIRE(m.size() == n * n);
  for (const std::string& line : lines_with(lammps, "pair_coeff")) {
    const auto w = words(line);
    const std::size_t a = std::stoul(w[1]) - 1, b = std::stoul(w[2]) - 1;
    for (const std::size_t at : {a * n + b, b * n + a}) {
      CHECK(kn[at] == w[4]);
      CHECK(gn[at] == w[5]);
      CHECK(kt[at] == w[8]);
      CHECK(mu[at] == w[10]);
      CHECK_THAT(std::stod(gt[at]), WithinRel(0.5 * std::stod(w[5]), rounding));
    }
  }
  for (std::size_t a = 0; a + 1 < n; ++a) {
    const auto w =
        words(lines_with(lammps, "fix             side" + std::to_string(a + 1) + " ").at(0));
    CHECK(kn[a * n + n - 1] == w[6]);
    CHECK(kn[(n - 1) * n + a] == w[6]);
    CHECK(mu[a * n + n - 1] == "0.1");
  }
}

TEST_CASE("Export: the YADE deck carries each value of the card, and our bonds", "[cli][export]") {
  Exported e;
  const ExportSpecimen s = bonded_specimen(e.source.set.material, 60, 2, e.packings);
  const auto files = yade_files(e.source, s);
  const std::string& deck = file(files, "unconfined_compression.py");
  for (const char* line :
       {"\nDENSITY = 2500\n", "\nCONTACT_MODULUS, CONTACT_RATIO, FRICTION = 3000000, 2.5, 0.45\n",
        "\nWALL_FRICTION = 0.1\n", "\nBOND_MODULUS, BOND_RATIO, BOND_RADIUS = 4000000, 1.5, 0.9\n",
        "\nTENSION, COHESION, BOND_ANGLE = 21000, 32000, 0.35\n",
        "\nMOMENT_SHARE, DAMPING = 0.6, 0.65\n", "\nBOTTOM, TOP = 0, 0.1\n",
        "# Fit: soil test_loam, seed 17", "#   bond_modulus_Pa = 4e+06 Pa, 95 % 3e+06 to 5e+06",
        "What YADE cannot express"})
    CHECK_THAT(deck, Contains(line));
  // 3e-4 of sqrt((3e6 + 4e6) / 2500), the speed of a confirming test
  const auto speed = words(lines_with(deck, "RADIUS, PLATEN_SPEED").at(0));
  CHECK_THAT(std::stod(speed[4]), WithinRel(0.75e-4 * std::sqrt(7e6 / 2500), rounding));
  CHECK(lines_with(file(files, "spheres.csv"), "").size() == 62);
  const auto bonds = lines_with(file(files, "bonds.csv"), "");
  REQUIRE(bonds.size() == s.bonds.size() + 2);
  CHECK(s.bonds.size() > 60);
  for (const BondGeometry& b : s.bonds) {
    const double distance_m =
        (s.position_m[static_cast<std::size_t>(b.i)] - s.position_m[static_cast<std::size_t>(b.j)])
            .norm();
    CHECK_THAT(b.rest_length_m, WithinRel(distance_m, rounding));
  }
}

TEST_CASE("Export: the PFC deck has its angle in degrees and says that nobody ran it",
          "[cli][export]") {
  Exported e;
  const ExportSpecimen s = bonded_specimen(e.source.set.material, 60, 2, e.packings);
  const std::string deck = file(pfc_files(e.source, s), "unconfined_compression.p3dat");
  CHECK_THAT(deck, Contains("NOT RUN by the authors"));
  CHECK(lines_with(deck, "ball create id").size() == 60);
  CHECK(lines_with(deck, "[map.add(pairs").size() == s.bonds.size());
  const auto strength = words(lines_with(deck, "        pb_coh").at(0));
  CHECK(strength[1] == "32000");
  CHECK_THAT(std::stod(strength[3]), WithinRel(20.0535228295788, 1e-12));  // 0.35 rad
  const auto first = words(lines_with(deck, "[map.add(pairs").at(0));
  CHECK(first[1] == std::to_string(s.bonds[0].i + 1));  // ids of PFC count from 1
  CHECK_THAT(deck, Contains("emod 3000000 kratio 2.5"));
  CHECK_THAT(deck, Contains("emod 4000000 kratio 1.5"));
  CHECK_THAT(deck, Contains("pb_rmul 0.9 pb_mcf 0.6 pb_ten 21000"));
}

TEST_CASE("Export: every format is written through the program, decks with our own curve",
          "[cli][export]") {
  Folder folder("program");
  const std::map<std::string, std::vector<std::string>> expected = {
      {"yade", {"unconfined_compression.py", "spheres.csv", "bonds.csv", "tilth_curve.csv"}},
      {"lammps", {"confined_compression.in", "spheres.data", "tilth_curve.csv"}},
      {"liggghts", {"confined_compression.in", "spheres.data", "platen.stl", "tilth_curve.csv"}},
      {"pfc", {"unconfined_compression.p3dat", "tilth_curve.csv"}}};
  for (const auto& [format, names] : expected) {
    const std::filesystem::path out = folder.path() / format;
    const Said said = run({folder.card().string(), "--format", format, "--out", out.string(),
                           "--particles", "60", "--seed", "2"});
    INFO(format << ": " << said.err);
    REQUIRE(said.code == 0);
    for (const std::string& name : names) {
      CHECK_THAT(said.out, Contains(name));
      CHECK(std::filesystem::file_size(out / name) > 50);
    }
    CHECK(Folder::read(out / names[0]).find('@') == std::string::npos);
  }
}

TEST_CASE("Export: bad input ends with code 2, a sentence and nothing written", "[cli][export]") {
  Folder folder("bad");
  const std::string card = folder.card().string();
  const std::filesystem::path out = folder.path() / "out";
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
    const Said said = run(arguments);
    CHECK(said.code == 2);
    CHECK_THAT(said.err, Contains(sentence));
    CHECK(said.out.empty());
    CHECK_FALSE(std::filesystem::exists(out));
  };
  refused({card, "--format", "lamps", "--out", out.string()},
          "unknown format 'lamps': known are json, csv, yade, lammps, liggghts, pfc; did you mean "
          "lammps?");
  refused({card, "--format", "yade", "--particles", "10", "--out", out.string()},
          "--particles 10: must be in");
  refused({(folder.path() / "none.json").string(), "--format", "yade", "--out", out.string()},
          "none.json");
  refused({card, "--format", "csv", "--out", (folder.card() / "below").string()},
          "cannot be written");
  const std::filesystem::path wrong = folder.path() / "wrong.json";
  std::ofstream(wrong)
      << R"({"schema": "tilth.card/1", "name": "x", "material": {"friction": -1}})";
  refused({wrong.string(), "--format", "yade", "--out", out.string()}, "/material/friction");
  refused({wrong.string(), "--format", "yade", "--out", out.string()}, "contact_modulus_Pa");
}

TEST_CASE("Deck templates: a name without value and a value without name are errors",
          "[cli][export]") {
  CHECK(fill_template("a @B_1@ c @B_1@", {{"B_1", "x"}}) == "a x c x");
  CHECK_THROWS_WITH(fill_template("@B@", {}), Contains("no value for B"));
  CHECK_THROWS_WITH(fill_template("a", {{"B", "x"}}), Contains("no place for B"));
  CHECK_THROWS_WITH(fill_template("a @ b", {}), Contains("lone @"));
  CHECK(comment_lines("#", {"a\nb", "", "c"}) == "# a b\n#\n# c");
}
