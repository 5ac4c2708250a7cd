// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Runs that go wrong end with a status and a sentence, and leave the pack's other members alone.
#include "experiments/lane_run.hpp"
#include "tests/experiments/small_tests.hpp"

using namespace tilth;
using namespace tilth::testing;
using Catch::Matchers::Contains;

namespace {

/// Bonds that push sideways the way they are sheared: what a user's file cannot say.
SoilMaterial exploding_soil() {
  SoilMaterial m = elastic_soil();
  m.bond.stiffness_ratio = -0.2;
  return m;
}

LaneRun free_specimen(std::span<const SoilMaterial> soils) {
  const UnconfinedCompressionConfig c = small_unconfined();
  const std::vector<Wall> walls = {
      {.direction = Vec3::UnitZ()},
      {.direction = -Vec3::UnitZ(), .position_m = c.specimen_height_m * Vec3::UnitZ()}};
  LaneRun run(make_specimen(*packings().get(packing_spec(c)), soils, walls, {}));
  for (int lane = 0; lane < run.num_lanes(); ++lane)
    run.specimen.state.drive(1, lane).velocity_m_per_s = -0.1 * Vec3::UnitZ();
  return run;
}

}  // namespace

TEST_CASE("Failed runs: an absurd member diverges with a message, its neighbours keep every bit",
          "[experiments][failures]") {
  const std::vector<SoilMaterial> sound = eight_soils();
  std::vector<SoilMaterial> soils = sound;
  soils[0] = soils[5] = exploding_soil();
  const auto check = [&](const std::vector<ExperimentResult>& good,
                         const std::vector<ExperimentResult>& mixed) {
    for (std::size_t k = 0; k < soils.size(); ++k) {
      INFO("member " << k);
      REQUIRE(good[k].status == RunStatus::completed);
      if (k != 0 && k != 5) {
        require_same(mixed[k], good[k]);
        continue;
      }
      REQUIRE(mixed[k].status == RunStatus::diverged);
      REQUIRE_THAT(mixed[k].message, Contains("diverged at step"));
      REQUIRE(mixed[k].num_steps > 0);
      REQUIRE(mixed[k].features.empty());
    }
  };
  check(run_unconfined_compression(sound, small_unconfined(), packings()),
        run_unconfined_compression(soils, small_unconfined(), packings()));
  check(run_confined_compression(sound, small_confined(), packings()),
        run_confined_compression(soils, small_confined(), packings()));
  check(run_direct_tension(sound, small_tension(), packings()),
        run_direct_tension(soils, small_tension(), packings()));
  DirectShearConfig shear = small_shear();
  shear.normal_stress_Pa = {10e3, 40e3};
  const auto mixed = run_direct_shear(soils, shear, packings());
  check(run_direct_shear(sound, shear, packings()), mixed);
  REQUIRE_THAT(mixed[0].message, Contains("at normal stress 1e+04 Pa"));
}

TEST_CASE("Failed runs: a time step of four times the stable one diverges, beside a sound lane",
          "[experiments][failures]") {
  const std::vector<SoilMaterial> soils(4, elastic_soil());
  LaneRun run = free_specimen(soils);
  LaneRun alone = free_specimen(std::span(soils).first(1));
  run.specimen.model.lanes[2].dt_s *= 4;
  const auto until_step_400 = [](LaneRun& r, int lane) {
    if (r.specimen.state.num_steps >= 400) r.finish(lane, RunStatus::completed, "done");
  };
  run_protocol(run, 20, 1000, {}, until_step_400);
  run_protocol(alone, 20, 1000, {}, until_step_400);
  REQUIRE(run.results[2].status == RunStatus::diverged);
  for (const int lane : {0, 1, 3}) {
    REQUIRE(run.results[static_cast<std::size_t>(lane)].status == RunStatus::completed);
    for (int i = 0; i < run.specimen.model.num_particles(); ++i)
      REQUIRE(run.specimen.state.position_m(i, lane) == alone.specimen.state.position_m(i, 0));
  }
}

TEST_CASE("Failed runs: what never reaches its end is not settled", "[experiments][failures]") {
  const SoilMaterial soil = bonded_soil();
  ConfinedCompressionConfig ring = small_confined();
  ring.max_axial_strain = 5e-3;  // 100 kPa need more
  const ExperimentResult r = run_confined_compression({&soil, 1}, ring, packings()).front();
  REQUIRE(r.status == RunStatus::not_settled);
  REQUIRE_THAT(r.message, Contains("reached strain 0.00") && Contains("before 1e+05 Pa"));
  REQUIRE(r.features.empty());
  REQUIRE_FALSE(r.curves.front().rows.empty());  // the curve so far helps to see why

  LaneRun endless = free_specimen({&soil, 1});
  run_protocol(endless, 20, 100, {}, [](LaneRun&, int) {});
  REQUIRE(endless.results.front().status == RunStatus::not_settled);
  REQUIRE(endless.results.front().num_steps == 100);
  REQUIRE_THAT(endless.results.front().message, Contains("within 100 steps"));
}

TEST_CASE("Failed runs: the stop flag ends every test at its next interval",
          "[experiments][failures]") {
  const std::vector<SoilMaterial> soils = eight_soils();
  const std::atomic<bool> stop = true;
  RunOptions options;
  options.stop = &stop;
  for (const auto& results :
       {run_unconfined_compression(soils, small_unconfined(), packings(), options),
        run_direct_shear(soils, small_shear(), packings(), options),
        run_direct_tension(soils, small_tension(), packings(), options),
        run_interface_shear(soils, small_interface(), packings(), options),
        run_confined_compression(soils, small_confined(), packings(), options)})
    for (const ExperimentResult& r : results) {
      REQUIRE(r.status == RunStatus::stopped);
      REQUIRE_THAT(r.message, Contains("stopped on request"));
      REQUIRE(r.num_steps <= 3 * 100);  // one interval; three normal stresses of the shear test
      REQUIRE(r.features.empty());
    }
}
