// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Local damping of an oscillation (docs/theory/damping.md, equation 3).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene.hpp"

using namespace tilth;
using Catch::Matchers::WithinRel;
using tilth::testing::Scene;

TEST_CASE("damping: a loaded spring keeps sqrt((1 - alpha) / (1 + alpha)) per half swing",
          "[dem_core][damping]") {
  for (const double alpha : {0.1, 0.3, 0.7}) {
    Scene scene;
    const double rest_m = 0.9;  // 1 kg under 1000 m/s2 on 1e4 N/m
    scene.sphere({0, 0, rest_m - 0.05});
    scene.plane(Vec3::UnitZ());
    scene.model.gravity_m_per_s2 = {0, 0, -1000};
    scene.law().local_damping = alpha;
    scene.law().dt_s = 1e-5;  // 3142 steps per half swing
    scene.begin();
    scene.run(10);
    double before_m = 0.05;
    for (int swing = 0; swing < 4; ++swing) {
      const auto rising = [&] { return scene.state.velocity_m_per_s(0).z() > 0; };
      const bool was_rising = rising();
      while (rising() == was_rising) scene.run(1);
      const double now_m = std::abs(scene.state.position_m(0).z() - rest_m);
      CAPTURE(alpha, swing);
      // 3e-3: the brake takes the sign of the last step's velocity, one step late of 3142
      CHECK_THAT(now_m / before_m, WithinRel(std::sqrt((1 - alpha) / (1 + alpha)), 3e-3));
      before_m = now_m;
    }
  }
}
