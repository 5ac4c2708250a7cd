// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/bond_strengths.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tilth {
namespace {

/// One round of splitmix64 (Steele, Lea & Flood, OOPSLA 2014): every bit of the result depends on all of x.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// cv^2 of a Weibull distribution of shape k.
double squared_cv(double k) { return std::expm1(std::lgamma(1 + 2 / k) - 2 * std::lgamma(1 + 1 / k)); }

bool differ(const SoilEffects& e) {
  return e.bond_strength_cv > 0 || e.bond_anisotropy != 0 || e.pan_strengthening > 0;
}

double orientation_factor(double anisotropy, const Vec3& branch, const Vec3& bedding) {
  const double cosine = branch.normalized().dot(bedding);
  return 1 + anisotropy * 0.5 * (3 * cosine * cosine - 1);
}

}  // namespace

double weibull_shape(double cv) {
  double low = 0.3, high = 1.3 / cv + 5;  // cv(0.3) is above 5; pi / (sqrt(6) k) from above for large k
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    (squared_cv(middle) > cv * cv ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

namespace {

struct Weibull {
  double inverse_shape = 0.0, scale = 1.0;
  explicit Weibull(double cv) {
    if (cv <= 0) return;
    inverse_shape = 1 / weibull_shape(cv);
    scale = std::exp(-std::lgamma(1 + inverse_shape));
  }
  double quantile(double u) const {
    return inverse_shape > 0 ? scale * std::pow(-std::log1p(-u), inverse_shape) : 1.0;
  }
};

}  // namespace

double weibull_quantile(double u, double cv) { return Weibull(cv).quantile(u); }

std::uint64_t packing_number(const Packing& packing) {
  std::uint64_t number = 0;
  for (const double r : packing.radius_m) number = mixed(number ^ std::bit_cast<std::uint64_t>(r));
  return number;
}

double bond_uniform(std::uint64_t packing_number, std::int32_t i, std::int32_t j) {
  const std::uint64_t pair = (static_cast<std::uint64_t>(i) << 32) | static_cast<std::uint32_t>(j);
  return (static_cast<double>(mixed(packing_number ^ mixed(pair)) >> 11) + 0.5) * 0x1.0p-53;
}

AlignedDoubles bond_strengths(const Model& model, const Packing& packing,
                              std::span<const SoilMaterial> materials, const BondPlace& place) {
  if (std::ranges::none_of(materials, [](const auto& m) { return differ(m.effects); })) return {};
  const std::uint64_t number = packing_number(packing);
  std::vector<Weibull> scatter;
  for (const SoilMaterial& m : materials) scatter.emplace_back(m.effects.bond_strength_cv);
  AlignedDoubles factors;
  for (const BondGeometry& b : model.bonds) {
    const Vec3& x = packing.position_m[static_cast<std::size_t>(b.i)];
    const Vec3& y = packing.position_m[static_cast<std::size_t>(b.j)];
    const double depth_m = place.surface_m - 0.5 * (x.z() + y.z());
    const double u = bond_uniform(number, b.i, b.j);
    for (std::size_t lane = 0; lane < materials.size(); ++lane) {
      const SoilEffects& e = materials[lane].effects;
      const double pan = depth_m > e.pan_depth_m ? 1 + e.pan_strengthening : 1.0;
      const double factor = scatter[lane].quantile(u) *
                            orientation_factor(e.bond_anisotropy, y - x, place.bedding) * pan;
      factors.push_back(std::max(factor, 0.01));
    }
  }
  return factors;
}

}  // namespace tilth
