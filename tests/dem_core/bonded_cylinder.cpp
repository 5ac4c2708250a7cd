// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The bonded cylinder against two independent public codes (tests/reference/bonded_cylinder).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;
using tilth::testing::BondedCylinder;
using tilth::testing::Scene;

namespace {

struct Row {
  double strain = 0, code_a = 0, code_b = 0, ours = 0;
};

/// Our stress at every row of the reference table.
std::vector<Row> crush() {
  std::vector<Row> rows;
  Scene scene = testing::bonded_cylinder(1);
  scene.begin();
  scene.state.drive(1, 0).velocity_m_per_s = {
      0, 0, -BondedCylinder::strain_rate_per_s * BondedCylinder::height_m};
  for (const auto& cells :
       testing::read_table(TILTH_SOURCE_DIR "/tests/reference/bonded_cylinder/curves.csv")) {
    scene.run(static_cast<int>(cells[0]) - static_cast<int>(scene.state.num_steps));
    rows.push_back({cells[1], cells[2], cells[3], testing::plate_stress_Pa(scene.state)});
  }
  return rows;
}

/// Slope of the least-squares line through the rows of strain 0.1 % to 0.4 %.
double modulus_Pa(const std::vector<Row>& rows, double Row::*stress) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Row& r : rows) {
    if (r.strain < 0.001 - 1e-9 || r.strain > 0.004 + 1e-9) continue;
    n += 1;
    sx += r.strain;
    sy += r.*stress;
    sxx += r.strain * r.strain;
    sxy += r.strain * r.*stress;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

Row peak(const std::vector<Row>& rows, double Row::*stress) {
  return *std::ranges::max_element(rows, {}, stress);
}

/// Mean of |ours - other| between two strains, over the mean of the other.
double mean_gap(const std::vector<Row>& rows, double Row::*other, double from, double to) {
  double gap = 0, scale = 0;
  for (const Row& r : rows) {
    if (r.strain < from || r.strain > to + 1e-9) continue;
    gap += std::abs(r.ours - r.*other);
    scale += r.*other;
  }
  return gap / scale;
}

double mean_stress(const std::vector<Row>& rows, double Row::*stress, double from, double to) {
  double sum = 0, n = 0;
  for (const Row& r : rows) {
    if (r.strain < from || r.strain > to + 1e-9) continue;
    sum += r.*stress;
    n += 1;
  }
  return sum / n;
}

}  // namespace

TEST_CASE("bonded cylinder agrees with two independent codes", "[dem_core][reference]") {
  const std::vector<Row> rows = crush();
  REQUIRE(rows.size() == 240);
  // the gate of the reference's README: the two codes differ by 0.02 %, 0.04 % and 0.04 %
  // themselves
  for (double Row::*code : {&Row::code_a, &Row::code_b}) {
    const double modulus = modulus_Pa(rows, &Row::ours);
    const double modulus_gap = modulus / modulus_Pa(rows, code) - 1;
    const double curve_gap = mean_gap(rows, code, 0, 0.008);
    const Row top = peak(rows, &Row::ours);
    const double peak_gap = top.ours / (peak(rows, code).*code) - 1;
    const double after = mean_stress(rows, &Row::ours, 0.0125, 0.018);
    const double after_code = mean_stress(rows, code, 0.0125, 0.018);
    CAPTURE(code == &Row::code_a, modulus, modulus_gap, curve_gap, top.ours, top.strain, peak_gap,
            after, after_code);
    CHECK(std::abs(modulus_gap) < 1e-3);
    CHECK(curve_gap < 5e-3);
    CHECK(std::abs(peak_gap) < 1e-2);
    CHECK_THAT(top.strain, WithinRel(peak(rows, code).strain, 0.02));  // 1.5 rows of the table
    // chaotic after the peak: changing one constant by 1e-9 gives means of 113 to 137 (15 runs:
    // mean 122, standard deviation 6.5), the two codes 131 and 134. 20 %: two and a half of these
    // deviations
    CHECK_THAT(after, WithinRel(after_code, 0.20));
  }
}
