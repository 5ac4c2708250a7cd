// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The contact law as a function of numbers; equations of docs/theory/contact.md.
#include "dem_core/contact_law.hpp"

#include <catch2/catch.hpp>

using namespace tilth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ContactConstants soil_contact() {
  return {.normal_stiffness_N_per_m = 2e5,
          .shear_stiffness_ratio = 0.4,
          .friction = 0.5,
          .normal_damping_N_s_per_m = 30,
          .tangential_damping_N_s_per_m = 10,
          .dt_s = 1e-4};
}

}  // namespace

TEST_CASE("contact law: the normal force is k d + c ddot, attractive when opening fast",
          "[dem_core][contact]") {
  const ContactConstants c = soil_contact();
  // contact.md (1); 1e-15: two roundings
  CHECK_THAT(
      contact_law(c, {.overlap_m = 1e-3, .overlap_rate_m_per_s = 0.2}, Vec3::Zero()).normal_N,
      WithinRel(206.0, 1e-15));
  CHECK_THAT(
      contact_law(c, {.overlap_m = 1e-3, .overlap_rate_m_per_s = -10}, Vec3::Zero()).normal_N,
      WithinRel(-100.0, 1e-15));
}

TEST_CASE("contact law: apart, every force is zero and the spring is forgotten",
          "[dem_core][contact]") {
  const ContactResponse r =
      contact_law(soil_contact(), {.overlap_m = -1e-9, .overlap_rate_m_per_s = 5}, {1e-4, 0, 0});
  CHECK(r.normal_N == 0.0);
  CHECK(r.tangential_on_a_N == Vec3::Zero());
  CHECK(r.spring_m == Vec3::Zero());
}

TEST_CASE("contact law: a sticking spring grows with the sliding and pulls a along with b",
          "[dem_core][contact]") {
  const ContactMotion m{.overlap_m = 1e-3, .sliding_velocity_m_per_s = {0.3, 0, 0}};
  const ContactResponse r = contact_law(soil_contact(), m, {1e-5, 0, 0});
  // contact.md (2), (3): s = 1e-5 + 1e-4 x 0.3 = 4e-5, F = 8e4 x 4e-5 + 10 x 0.3 = 6.2 N < 100 N
  CHECK_THAT(r.spring_m.x(), WithinRel(4e-5, 1e-14));
  CHECK_THAT(r.tangential_on_a_N.x(), WithinRel(6.2, 1e-14));
}

TEST_CASE("contact law: a slipping contact carries friction times the normal force",
          "[dem_core][contact]") {
  const ContactMotion m{.overlap_m = 1e-3, .sliding_velocity_m_per_s = {3, 4, 0}};
  const ContactResponse r = contact_law(soil_contact(), m, {3e-2, 4e-2, 0});
  // contact.md (4): |F| = 0.5 x 200 N along (0.6, 0.8); s = (F - 10 v) / 8e4
  CHECK_THAT(r.tangential_on_a_N.norm(), WithinRel(100.0, 1e-14));
  CHECK_THAT(r.tangential_on_a_N.x(), WithinRel(60.0, 1e-14));
  CHECK_THAT(r.spring_m.x(), WithinRel((60.0 - 30.0) / 8e4, 1e-13));
  CHECK_THAT(r.spring_m.y(), WithinRel((80.0 - 40.0) / 8e4, 1e-13));
}

TEST_CASE("contact law: without pressure there is no friction", "[dem_core][contact]") {
  // a contact pulled back by its dashpot (F_n < 0) cannot carry shear: contact.md (4)
  const ContactMotion m{
      .overlap_m = 1e-4, .overlap_rate_m_per_s = -10, .sliding_velocity_m_per_s = {1, 0, 0}};
  const ContactResponse r = contact_law(soil_contact(), m, Vec3::Zero());
  CHECK(r.normal_N < 0);
  CHECK(r.tangential_on_a_N.norm() == 0.0);
}

TEST_CASE("contact law: the spring stays in the contact plane", "[dem_core][contact]") {
  const Vec3 normal = Vec3(1, 2, 2) / 3;
  const ContactMotion m{.normal = normal, .overlap_m = 1e-3};
  const ContactResponse r = contact_law(soil_contact(), m, {1e-5, 0, 0});
  CHECK_THAT(r.spring_m.dot(normal), WithinAbs(0, 1e-20));  // 1e-5 m x rounding
  // the projection of (1e-5, 0, 0): length 1e-5 sqrt(1 - 1/9)
  CHECK_THAT(r.spring_m.norm(), WithinRel(1e-5 * std::sqrt(8.0 / 9.0), 1e-14));
}
