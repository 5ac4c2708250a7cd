// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "tests/calibrate/mgh_problems.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace tilth::test {
namespace {

using Vector = Eigen::VectorXd;

// sum over i < count of one residual each
Vector each(int count, const std::function<double(int)>& residual) {
  Vector r(count);
  for (int i = 0; i < count; ++i) r[i] = residual(i);
  return r;
}

Vector list(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

double square(double v) { return v * v; }

Vector rosenbrock(const Vector& x) { return list({10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]}); }

Vector freudenstein_roth(const Vector& x) {
  return list({-13.0 + x[0] + ((5.0 - x[1]) * x[1] - 2.0) * x[1],
               -29.0 + x[0] + ((x[1] + 1.0) * x[1] - 14.0) * x[1]});
}

Vector powell_badly_scaled(const Vector& x) {
  return list({1e4 * x[0] * x[1] - 1.0, std::exp(-x[0]) + std::exp(-x[1]) - 1.0001});
}

Vector brown_badly_scaled(const Vector& x) {
  return list({x[0] - 1e6, x[1] - 2e-6, x[0] * x[1] - 2.0});
}

Vector beale(const Vector& x) {
  return list({1.5 - x[0] * (1.0 - x[1]), 2.25 - x[0] * (1.0 - std::pow(x[1], 2)),
               2.625 - x[0] * (1.0 - std::pow(x[1], 3))});
}

Vector jennrich_sampson(const Vector& x) {
  return each(10, [&](int i) {
    const double k = i + 1.0;
    return 2.0 + 2.0 * k - std::exp(k * x[0]) - std::exp(k * x[1]);
  });
}

Vector helical_valley(const Vector& x) {
  const double turns = 0.5 / std::numbers::pi * std::atan(x[1] / x[0]) + (x[0] > 0.0 ? 0.0 : 0.5);
  return list({10.0 * (x[2] - 10.0 * turns), 10.0 * (std::hypot(x[0], x[1]) - 1.0), x[2]});
}

Vector bard(const Vector& x) {
  constexpr std::array y = {0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39,
                            0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39};
  return each(15, [&](int i) {
    const double u = i + 1.0;
    const double v = 15.0 - i;
    return y[static_cast<std::size_t>(i)] - (x[0] + u / (v * x[1] + std::min(u, v) * x[2]));
  });
}

Vector gaussian(const Vector& x) {
  constexpr std::array y = {0.0009, 0.0044, 0.0175, 0.0540, 0.1295, 0.2420, 0.3521, 0.3989};
  return each(15, [&](int i) {
    const double t = (7.0 - i) / 2.0;
    const auto k = static_cast<std::size_t>(std::min(i, 14 - i));
    return x[0] * std::exp(-x[1] * square(t - x[2]) / 2.0) - y[k];
  });
}

Vector meyer(const Vector& x) {
  constexpr std::array y = {34780.0, 28610.0, 23650.0, 19630.0, 16370.0, 13720.0, 11540.0, 9744.0,
                            8261.0,  7030.0,  6005.0,  5147.0,  4427.0,  3820.0,  3307.0,  2872.0};
  return each(16, [&](int i) {
    return x[0] * std::exp(x[1] / (50.0 + 5.0 * i + x[2])) - y[static_cast<std::size_t>(i)];
  });
}

// With |y_i - x2|: the printed paper's y_i * m * i * x2 is a misprint.
Vector gulf(const Vector& x) {
  return each(100, [&](int i) {
    const double t = (i + 1.0) / 100.0;
    const double y = 25.0 + std::pow(-50.0 * std::log(t), 2.0 / 3.0);
    return std::exp(-std::pow(std::abs(y - x[1]), x[2]) / x[0]) - t;
  });
}

Vector box_3d(const Vector& x) {
  return each(10, [&](int i) {
    const double t = 0.1 * (i + 1.0);
    return std::exp(-t * x[0]) - std::exp(-t * x[1]) - x[2] * (std::exp(-t) - std::exp(-10.0 * t));
  });
}

Vector powell_singular(const Vector& x) {
  return list({x[0] + 10.0 * x[1], std::sqrt(5.0) * (x[2] - x[3]), square(x[1] - 2.0 * x[2]),
               std::sqrt(10.0) * square(x[0] - x[3])});
}

Vector wood(const Vector& x) {
  return list({10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0], std::sqrt(90.0) * (x[3] - x[2] * x[2]),
               1.0 - x[2], std::sqrt(10.0) * (x[1] + x[3] - 2.0), (x[1] - x[3]) / std::sqrt(10.0)});
}

Vector kowalik_osborne(const Vector& x) {
  constexpr std::array y = {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627,
                            0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
  constexpr std::array u = {4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
  return each(11, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return y[k] - x[0] * u[k] * (u[k] + x[1]) / (u[k] * (u[k] + x[2]) + x[3]);
  });
}

Vector brown_dennis(const Vector& x) {
  return each(20, [&](int i) {
    const double t = (i + 1.0) / 5.0;
    return square(x[0] + t * x[1] - std::exp(t)) + square(x[2] + x[3] * std::sin(t) - std::cos(t));
  });
}

Vector osborne_1(const Vector& x) {
  constexpr std::array y = {0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818,
                            0.784, 0.751, 0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558,
                            0.538, 0.522, 0.506, 0.490, 0.478, 0.467, 0.457, 0.448, 0.438,
                            0.431, 0.424, 0.420, 0.414, 0.411, 0.406};
  return each(33, [&](int i) {
    const double t = 10.0 * i;
    return y[static_cast<std::size_t>(i)] -
           (x[0] + x[1] * std::exp(-t * x[3]) + x[2] * std::exp(-t * x[4]));
  });
}

Vector biggs_exp6(const Vector& x) {
  return each(13, [&](int i) {
    const double t = 0.1 * (i + 1.0);
    const double y = std::exp(-t) - 5.0 * std::exp(-10.0 * t) + 3.0 * std::exp(-4.0 * t);
    return x[2] * std::exp(-t * x[0]) - x[3] * std::exp(-t * x[1]) + x[5] * std::exp(-t * x[4]) - y;
  });
}

Vector osborne_2(const Vector& x) {
  constexpr std::array y = {
      1.366, 1.191, 1.112, 1.013, 0.991, 0.885, 0.831, 0.847, 0.786, 0.725, 0.746, 0.679, 0.608,
      0.655, 0.616, 0.606, 0.602, 0.626, 0.651, 0.724, 0.649, 0.649, 0.694, 0.644, 0.624, 0.661,
      0.612, 0.558, 0.533, 0.495, 0.500, 0.423, 0.395, 0.375, 0.372, 0.391, 0.396, 0.405, 0.428,
      0.429, 0.523, 0.562, 0.607, 0.653, 0.672, 0.708, 0.633, 0.668, 0.645, 0.632, 0.591, 0.559,
      0.597, 0.625, 0.739, 0.710, 0.729, 0.720, 0.636, 0.581, 0.428, 0.292, 0.162, 0.098, 0.054};
  return each(65, [&](int i) {
    const double t = i / 10.0;
    return y[static_cast<std::size_t>(i)] -
           (x[0] * std::exp(-t * x[4]) + x[1] * std::exp(-square(t - x[8]) * x[5]) +
            x[2] * std::exp(-square(t - x[9]) * x[6]) + x[3] * std::exp(-square(t - x[10]) * x[7]));
  });
}

}  // namespace

std::vector<MghProblem> mgh_problems() {
  return {{"Rosenbrock", {-1.2, 1.0}, rosenbrock, {0.0}, {}, {}, 0.0},
          {"Freudenstein-Roth", {0.5, -2.0}, freudenstein_roth, {0.0, 48.9842536792}, {}, {}, 0.0},
          {"Powell badly scaled",
           {0.0, 1.0},
           powell_badly_scaled,
           {0.0},
           {0.0, 1.0},
           {1.0, 9.0},
           1.5125900e-10},
          {"Brown badly scaled",
           {1.0, 1.0},
           brown_badly_scaled,
           {0.0},
           {0.0, 3e-5},
           {1e6, 100.0},
           784.0},
          {"Beale", {1.0, 1.0}, beale, {0.0}, {0.6, 0.5}, {10.0, 100.0}, 0.0},
          {"Jennrich-Sampson", {0.3, 0.4}, jennrich_sampson, {124.362182}, {}, {}, 0.0},
          {"helical valley",
           {-1.0, 0.0, 0.0},
           helical_valley,
           {0.0},
           {-100.0, -1.0, -1.0},
           {0.8, 1.0, 1.0},
           0.99042212},
          {"Bard", {1.0, 1.0, 1.0}, bard, {8.21487e-3, 17.4286}, {}, {}, 0.0},
          {"Gaussian",
           {0.4, 1.0, 0.0},
           gaussian,
           {1.12793e-8},
           {0.398, 1.0, -0.5},
           {4.2, 2.0, 0.1},
           1.12793e-8},
          {"Meyer", {0.02, 4000.0, 250.0}, meyer, {87.9458}, {}, {}, 0.0},
          {"Gulf",
           {5.0, 2.5, 0.15},
           gulf,
           {0.0},
           {1e-16, 0.0, 0.0},
           {10.0, 10.0, 10.0},
           5.8281431e-5,
           3},
          {"Box 3D",
           {0.0, 10.0, 20.0},
           box_3d,
           {0.0, 0.0755887},
           {0.0, 5.0, 0.0},
           {2.0, 9.5, 20.0},
           3.0998153e-6,
           3},
          {"Powell singular", {3.0, -1.0, 0.0, 1.0}, powell_singular, {0.0}, {}, {}, 0.0},
          {"Wood",
           {-3.0, -1.0, -3.0, -1.0},
           wood,
           {0.0},
           {-100.0, -100.0, -100.0, -100.0},
           {0.0, 10.0, 100.0, 100.0},
           1.5567008},
          {"Kowalik-Osborne",
           {0.25, 0.39, 0.415, 0.39},
           kowalik_osborne,
           {3.07505e-4, 1.02734e-3},
           {},
           {},
           0.0},
          {"Brown-Dennis",
           {25.0, 5.0, -5.0, -1.0},
           brown_dennis,
           {85822.2},
           {-10.0, 0.0, -100.0, -20.0},
           {100.0, 15.0, 0.0, 0.2},
           88860.479},
          {"Osborne 1", {0.5, 1.5, -1.0, 0.01, 0.02}, osborne_1, {5.46489e-5}, {}, {}, 0.0},
          {"Biggs EXP6",
           {1.0, 2.0, 1.0, 1.0, 1.0, 1.0},
           biggs_exp6,
           {0.0, 5.65565e-3, 0.306366772},
           {0.0, 0.0, 0.0, 1.0, 0.0, 0.0},
           {2.0, 8.0, 1.0, 7.0, 5.0, 5.0},
           5.3209865e-4},
          {"Osborne 2",
           {1.3, 0.65, 0.65, 0.7, 0.6, 3.0, 5.0, 7.0, 2.0, 4.5, 5.5},
           osborne_2,
           {4.01377e-2},
           {},
           {},
           0.0}};
}

}  // namespace tilth::test
