// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "calibrate/diagnosis/measured_campaign.hpp"

#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>

#include "calibrate/diagnosis/guards.hpp"

using namespace tilth;

namespace {

SoilTarget row(const std::string& test, const std::string& observable, const std::string& condition,
               const std::string& replicate, double value) {
  SoilTarget t;
  t.test_id = test;
  t.observable_id = observable;
  t.condition_id = condition;
  t.replicate_id = replicate;
  t.value = value;
  t.sigma = 0.2;
  t.sigma_kind = SigmaKind::log;
  t.observation_groups = {test + observable + condition};
  return t;
}

SoilData two_tests() {
  SoilData soil;
  soil.id = "soil";
  for (const auto& [specimen, peak] : {std::pair{"a", 10e3}, {"b", 12e3}, {"c", 14e3}}) {
    soil.targets.push_back(row("unconfined_compression", "peak_stress_Pa", "dry", specimen, peak));
    soil.targets.push_back(row("unconfined_compression", "secant_modulus_Pa", "dry", specimen, 100 * peak));
  }
  for (const auto& [specimen, peak] : {std::pair{"a", 20e3}, {"b", 24e3}, {"c", 28e3}})
    soil.targets.push_back(row("unconfined_compression", "peak_stress_Pa", "wet", specimen, peak));
  return soil;
}

}  // namespace

TEST_CASE("Campaign: replicates become one number with the error of their mean", "[diagnosis]") {
  const MeasuredCampaign c = measured_campaign(two_tests());
  REQUIRE(c.means.targets.size() == 3);
  REQUIRE(c.tests.size() == 2);
  CHECK(c.has_replicates);
  const double mean = (std::log(10.0) + std::log(12.0) + std::log(14.0)) / 3.0;
  CHECK(c.means.targets[0].value == Approx(1e3 * std::exp(mean)));
  CHECK(c.means.targets[0].replicate_id.empty());
  // both conditions scatter alike: pooled and own variances agree, so the moderated one is the same
  const double v = (std::pow(std::log(10.0) - mean, 2) + std::pow(std::log(12.0) - mean, 2) + std::pow(std::log(14.0) - mean, 2)) / 2.0;
  CHECK(c.prior_variances[0] == Approx(v));
  CHECK(c.means.targets[0].sigma == Approx(std::sqrt(v / 3.0)));
  // two degrees of freedom only: the stated sigma is believed first
  CHECK(c.prior_variances[1] == Approx(0.04));
  CHECK(c.tests[0].replicates.rows() == 3);
  CHECK(c.tests[0].replicates(1, 0) == Approx(std::log(12e3)));
}

TEST_CASE("Campaign: order of rows and names of specimens change nothing", "[diagnosis]") {
  const MeasuredCampaign c = measured_campaign(two_tests());
  SoilData shuffled = two_tests();
  std::swap(shuffled.targets[0], shuffled.targets[4]);
  std::swap(shuffled.targets[1], shuffled.targets[5]);
  const MeasuredCampaign d = measured_campaign(shuffled);
  CHECK(d.tests[0].replicates == c.tests[0].replicates);
  CHECK(d.means.targets[0].value == c.means.targets[0].value);
}

TEST_CASE("Campaign: a specimen that lacks a number is left out of its test, and it is said", "[diagnosis]") {
  SoilData soil = two_tests();
  soil.targets.erase(soil.targets.begin() + 1);  // modulus of specimen a
  const MeasuredCampaign c = measured_campaign(soil);
  CHECK(c.tests[0].replicates.rows() == 2);
  REQUIRE(c.remarks.size() == 1);
  CHECK(c.remarks[0].find("1 specimens without all numbers") != std::string::npos);
}

TEST_CASE("Campaign: equal replicates or none lean on the stated sigma and are marked", "[diagnosis]") {
  SoilData soil = two_tests();
  for (SoilTarget& t : soil.targets) t.value = 15e3;
  const MeasuredCampaign equal = measured_campaign(soil);
  CHECK_FALSE(equal.has_replicates);
  CHECK(equal.prior_variances[0] == Approx(0.04));
  CHECK(std::ranges::any_of(equal.remarks, [](const std::string& s) { return s.find("all equal") != std::string::npos; }));
  std::erase_if(soil.targets, [](const SoilTarget& t) { return t.replicate_id != "a"; });
  const MeasuredCampaign single = measured_campaign(soil);
  CHECK_FALSE(single.has_replicates);
  CHECK(single.means.targets[0].sigma == Approx(0.2));
}

TEST_CASE("Campaign: what cannot be is refused with every row", "[diagnosis][bad_input]") {
  SoilData soil = two_tests();
  soil.targets[0].value = -1.0;
  soil.targets[2].holdout = true;
  soil.targets[6].x = 0.1;
  try {
    (void)measured_campaign(soil);
    FAIL("was taken");
  } catch (const ConfigError& e) {
    CHECK(e.sentences().size() >= 3);
  }
}

namespace {

Diagnosis named(const std::string& id) {
  Diagnosis d;
  d.verdict = Verdict::named;
  d.reason = "posterior";
  NamedEffect e;
  e.id = id;
  d.effects = {e};
  return d;
}

}  // namespace

TEST_CASE("Guards: without replicates a name is a suggestion", "[diagnosis]") {
  Diagnosis d = named("plastic_contact");
  apply_guards({.has_replicates = false, .failed_gates = {}}, d);
  CHECK(d.verdict == Verdict::suggested);
  Diagnosis kept = named("plastic_contact");
  apply_guards({.has_replicates = true, .failed_gates = {"loading_rate"}}, kept);
  CHECK(kept.verdict == Verdict::named);
}

TEST_CASE("Guards: a rate effect is not named while the simulation's own speed matters", "[diagnosis]") {
  Diagnosis d = named("rate_dependent_strength");
  apply_guards({.has_replicates = true, .failed_gates = {"loading_rate"}}, d);
  CHECK(d.verdict == Verdict::set);
  CHECK(d.effects.empty());
  CHECK(d.set == std::vector<std::string>{"rate_dependent_strength", "loading_rate"});
}
