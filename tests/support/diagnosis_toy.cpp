// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "tests/support/diagnosis_toy.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "calibrate/diagnosis/normal_probability.hpp"
#include "calibrate/diagnosis/separability.hpp"

namespace tilth::test {
namespace {

constexpr double parameter_step = 0.336;  // ln 1.4: the table's parameter rows are for +40 %
constexpr double parameter_offset = 0.05;
constexpr int num_specimens = 5;
constexpr int num_packings = 8;
constexpr double packing_cv = 0.07;
constexpr double within_test = 0.3;
constexpr double paired_correlation = 0.8;
constexpr double spread_of_cv = 0.25;  // log sd: what 8 degrees of freedom leave open
constexpr double outside_norm = 8.0;
constexpr double outside_cosine = 0.6;

struct Share {
  std::string measure;
  double weight = 1.0;
};

// One statistic: its test (one specimen), the rows of the table it is the sum of, and its noise.
struct PlannedStatistic {
  std::string test, name;
  std::vector<Share> shares;
  double specimen_cv = 0.1;
};

double log_change(int level) {
  constexpr std::array<double, 4> sizes = {0.0, 0.06, 0.18, 0.40};
  return std::copysign(sizes[static_cast<std::size_t>(std::abs(level))], level);
}

// "direct_shear/10kPa" is a test of the rig "direct_shear".
std::string rig_of(const std::string& test) { return test.substr(0, test.find('/')); }

void plan_laboratory(std::vector<PlannedStatistic>& plan) {
  const std::string ucs = "unconfined_compression/slow";
  plan.push_back({ucs, "modulus", {{"ucs_modulus"}}, 0.15});
  plan.push_back({ucs, "peak", {{"ucs_peak"}}, 0.10});
  plan.push_back({ucs, "strain_at_peak", {{"ucs_strain_at_peak"}}, 0.10});
  plan.push_back({ucs, "drop", {{"ucs_drop"}}, 0.20});
  plan.push_back({"unconfined_compression/fast", "peak", {{"ucs_fast_peak"}}, 0.10});
  plan.push_back({"brazilian/small", "strength", {{"bt_strength"}}, 0.15});
  plan.push_back({"brazilian/large", "strength", {{"bt_strength"}, {"bt_size_effect"}}, 0.15});
  plan.push_back({"brazilian/scatter", "scatter", {{"bt_scatter"}}, 0.45});
  const std::array<const char*, 3> stresses = {"10kPa", "32kPa", "100kPa"};
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const double high = 0.5 * static_cast<double>(i);
    const std::string test = std::string("direct_shear/") + stresses[i];
    plan.push_back({test, "peak", {{"ds_peak_10kPa", 1.0 - high}, {"ds_peak_100kPa", high}}, 0.08});
    plan.push_back({test,
                    "residual",
                    {{"ds_residual_10kPa", 1.0 - high}, {"ds_residual_100kPa", high}},
                    0.08});
    if (i == 2) plan.push_back({test, "dilation", {{"ds_dilation"}}, 0.20});
  }
  const std::string oed = "oedometer/load";
  plan.push_back({oed, "strain_25kPa", {{"oed_strain_25kPa"}}, 0.15});
  plan.push_back(
      {oed, "strain_71kPa", {{"oed_strain_25kPa", 0.5}, {"oed_strain_200kPa", 0.5}}, 0.15});
  plan.push_back({oed, "strain_200kPa", {{"oed_strain_200kPa"}}, 0.15});
  plan.push_back({oed, "unload_ratio", {{"oed_unload_ratio"}}, 0.15});
}

void plan_bed(std::vector<PlannedStatistic>& plan) {
  const std::string cone = "cone/profile";
  plan.push_back({cone, "5cm", {{"cpt_5cm"}}, 0.15});
  plan.push_back({cone, "12cm", {{"cpt_5cm", 0.5}, {"cpt_20cm", 0.5}}, 0.15});
  plan.push_back({cone, "20cm", {{"cpt_20cm"}}, 0.15});
  plan.push_back({"repose/heap", "angle", {{"aor_angle"}}, 0.05});
}

void plan_field(std::vector<PlannedStatistic>& plan) {
  for (int depth = 0; depth < 3; ++depth) {
    const double deep = 0.5 * depth;
    const std::string place = std::string("draught/depth") + std::to_string(depth);
    plan.push_back({place + "_slow", "draught", {{"dr_draught"}, {"dr_depth_slope", deep}}, 0.10});
    plan.push_back({place + "_slow", "vertical", {{"dr_vertical"}}, 0.25});
    plan.push_back({place + "_fast",
                    "draught",
                    {{"dr_draught"}, {"dr_depth_slope", deep}, {"dr_speed_slope"}},
                    0.10});
  }
  for (int depth = 0; depth < 3; ++depth)
    plan.push_back({"tracers/line", "depth" + std::to_string(depth), {{"tr_displacement"}}, 0.20});
}

void plan_extras(std::vector<PlannedStatistic>& plan) {
  plan.push_back({"refinement/half_size", "draught", {{"extra_size_halving"}}, 0.05});
  for (const char* stress : {"10kPa", "50kPa", "100kPa"})
    plan.push_back({std::string("steel_shear/") + stress,
                    "peak",
                    {{std::string("extra_steel_shear_") + stress}},
                    0.10});
  plan.push_back({"unconfined_compression/tenfold", "peak", {{"extra_ucs_10x_rate"}}, 0.10});
  plan.push_back({"cone/pull_out", "force", {{"extra_cone_pull_out"}}, 0.20});
  plan.push_back({"brazilian/fifteen", "scatter", {{"extra_bt_scatter_15"}}, 0.25});
  plan.push_back({"direct_shear/rotated", "peak", {{"extra_ds_rotated_cut"}}, 0.08});
  plan.push_back({"oedometer/second_loop", "unload_ratio", {{"extra_second_unload"}}, 0.15});
}

std::vector<PlannedStatistic> plan_of(ToyData data) {
  std::vector<PlannedStatistic> plan;
  if (data != ToyData::field) {
    plan_laboratory(plan);
    plan_bed(plan);
  }
  plan_field(plan);
  if (data == ToyData::extras) plan_extras(plan);
  return plan;
}

Eigen::VectorXd changes_of(const DirectionTable& table, const DirectionRow& row,
                           const std::vector<PlannedStatistic>& plan) {
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(plan.size()));
  for (std::size_t i = 0; i < plan.size(); ++i)
    for (const Share& share : plan[i].shares)
      changes[static_cast<Eigen::Index>(i)] +=
          share.weight * log_change(row.levels[table.measure(share.measure)]);
  return changes;
}

double packing_noise_of_secant() {
  return packing_cv * std::sqrt(2.0 * (1.0 - paired_correlation) / num_packings);
}

Eigen::VectorXd normal_vector(Eigen::Index size, std::mt19937_64& rng) {
  Eigen::VectorXd x(size);
  for (double& number : x) number = standard_normal(rng);
  return x;
}

// 1 for the rows of every rig in which the column is not zero everywhere.
Eigen::VectorXd touched_rows(const LinearModel& model, const Eigen::VectorXd& column) {
  Eigen::VectorXd touched = Eigen::VectorXd::Zero(column.size());
  for (const std::string& rig : experiments_of(model)) {
    const std::vector<Eigen::Index> rows = rows_of(model, rig);
    if (!column(rows).isZero(0.0)) touched(rows).setOnes();
  }
  return touched;
}

void append_column(Eigen::MatrixXd& matrix, const Eigen::VectorXd& column) {
  matrix.conservativeResize(column.size(), matrix.cols() + 1);
  matrix.rightCols(1) = column;
}

}  // namespace

Toy::Toy(ToyData data, const std::string& left_out) {
  const DirectionTable table =
      read_effect_directions(std::string(TILTH_SOURCE_DIR) + "/data/effect_directions.csv");
  const std::vector<PlannedStatistic> plan = plan_of(data);
  noise_.replicate_variances.resize(static_cast<Eigen::Index>(plan.size()));
  noise_.packing_variances =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(plan.size()), packing_cv * packing_cv);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    exact_.statistics.push_back({rig_of(plan[i].test), plan[i].test + "." + plan[i].name});
    noise_.replicate_variances[static_cast<Eigen::Index>(i)] = std::pow(plan[i].specimen_cv, 2);
    if (tests_.empty() || tests_.back().name != plan[i].test) tests_.push_back({plan[i].test, {}});
    tests_.back().statistics.push_back(static_cast<Eigen::Index>(i));
  }
  for (const DirectionRow& row : table.rows) {
    if (row.short_name == "BFRIC") continue;  // one family with TENC
    const Eigen::VectorXd changes = changes_of(table, row, plan);
    if (row.is_parameter) {
      append_column(exact_.jacobian, changes / parameter_step);
      continue;
    }
    ids_.push_back(row.id);
    short_names_.push_back(row.short_name);
    append_column(effects_, changes);
    if (row.id == left_out) continue;
    append_column(exact_.fingerprints, changes);
    candidates_.push_back({row.id, row.sign, 1.0, 1.0, false});
  }
}

std::optional<std::size_t> Toy::position(Eigen::Index effect) const {
  const auto found =
      std::ranges::find(candidates_, ids_[static_cast<std::size_t>(effect)], &CandidateEffect::id);
  if (found == candidates_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - candidates_.begin());
}

Eigen::MatrixXd Toy::usual_covariance() const {
  std::vector<TestSamples> one;
  for (const TestPlan& test : tests_) {
    const auto m = static_cast<Eigen::Index>(test.statistics.size());
    one.push_back({test.statistics, Eigen::MatrixXd::Zero(1, m), Eigen::MatrixXd::Zero(1, m)});
  }
  const NoiseCovariance v = noise_covariance(one, noise_);
  return v.replicate / num_specimens + v.packing / num_packings;
}

TestSamples Toy::samples_of(const TestPlan& test, const Eigen::VectorXd& centre,
                            std::mt19937_64& rng) const {
  const auto m = static_cast<Eigen::Index>(test.statistics.size());
  const auto scattered = [&](int num, const Eigen::VectorXd& variances, bool shifted) {
    const Eigen::ArrayXd deviation = Eigen::VectorXd(variances(test.statistics)).array().sqrt() *
                                     (spread_of_cv * normal_vector(m, rng).array()).exp();
    Eigen::MatrixXd samples(num, m);
    for (Eigen::Index i = 0; i < num; ++i) {
      const double shared = std::sqrt(within_test) * standard_normal(rng);
      const Eigen::ArrayXd own = std::sqrt(1.0 - within_test) * normal_vector(m, rng).array();
      samples.row(i) = (deviation * (own + shared)).matrix().transpose();
    }
    if (shifted) samples.rowwise() += Eigen::VectorXd(centre(test.statistics)).transpose();
    return samples;
  };
  return {test.statistics, scattered(num_specimens, noise_.replicate_variances, true),
          scattered(num_packings, noise_.packing_variances, false)};
}

LinearModel Toy::seen_model(std::mt19937_64& rng) const {
  LinearModel seen = exact_;
  const double noise = packing_noise_of_secant();
  seen.fingerprint_variances =
      Eigen::MatrixXd::Zero(seen.fingerprints.rows(), seen.fingerprints.cols());
  for (Eigen::Index k = 0; k < seen.fingerprints.cols(); ++k) {
    const Eigen::VectorXd touched = touched_rows(exact_, exact_.fingerprints.col(k));
    seen.fingerprints.col(k) += noise * touched.cwiseProduct(normal_vector(touched.size(), rng));
    seen.fingerprint_variances.col(k) = noise * noise * touched;
  }
  // Two-sided steps of parameter_step.
  const double slope_noise = noise / (2.0 * parameter_step);
  seen.jacobian_variances = Eigen::MatrixXd::Zero(seen.jacobian.rows(), seen.jacobian.cols());
  for (Eigen::Index j = 0; j < seen.jacobian.cols(); ++j) {
    const Eigen::VectorXd touched = touched_rows(exact_, exact_.jacobian.col(j));
    seen.jacobian.col(j) += slope_noise * touched.cwiseProduct(normal_vector(touched.size(), rng));
    seen.jacobian_variances.col(j) = slope_noise * slope_noise * touched;
  }
  return seen;
}

ToyCase Toy::campaign(const Eigen::VectorXd& shift, const Eigen::VectorXd& truth,
                      std::mt19937_64& rng) const {
  ToyCase made;
  made.truth = truth;
  made.evidence.soil = "toy";
  made.evidence.model = seen_model(rng);
  made.evidence.noise = noise_;
  made.evidence.candidates = candidates_;
  const Eigen::VectorXd offset = parameter_offset * normal_vector(exact_.jacobian.cols(), rng);
  const Eigen::VectorXd centre = exact_.jacobian * offset + shift;
  for (const TestPlan& test : tests_)
    made.evidence.samples.push_back(samples_of(test, centre, rng));
  return made;
}

ToyCase Toy::hidden(const Eigen::VectorXd& sizes, std::mt19937_64& rng) const {
  return campaign(effects_ * sizes, sizes, rng);
}

ToyCase Toy::hidden(Eigen::Index effect, double size, std::mt19937_64& rng) const {
  return hidden(size * Eigen::VectorXd::Unit(num_effects(), effect), rng);
}

ToyCase Toy::outside(std::mt19937_64& rng) const {
  const Eigen::MatrixXd v = usual_covariance();
  const std::vector<std::string> rigs = experiments_of(exact_);
  for (int attempt = 0; attempt < 10000; ++attempt) {
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(v.rows());
    const auto num_rigs = 1 + rng() % std::min<std::size_t>(3, rigs.size());
    for (std::size_t i = 0; i < num_rigs; ++i) {
      const std::vector<Eigen::Index> rows = rows_of(exact_, rigs[rng() % rigs.size()]);
      shift(rows) = normal_vector(static_cast<Eigen::Index>(rows.size()), rng);
    }
    const ProjectedEvidence seen = project(exact_, shift, v);
    const double norm = seen.u.norm();
    const double closest = signed_scores(seen).cwiseAbs().maxCoeff() / norm;
    // A shift that the parameters absorb almost wholly would become enormous.
    if (norm > 0.2 * whitened(exact_, shift, v).residual.norm() && closest < outside_cosine)
      return campaign(outside_norm / norm * shift, Eigen::VectorXd::Zero(num_effects()), rng);
  }
  throw std::logic_error("no shift outside the catalogue was found");
}

ToyCase Toy::shuffled(Eigen::Index effect, std::mt19937_64& rng) const {
  Eigen::VectorXd shift = effects_.col(effect);
  for (Eigen::Index i = shift.size(); i > 1; --i)
    std::swap(shift[i - 1],
              shift[static_cast<Eigen::Index>(rng() % static_cast<std::uint64_t>(i))]);
  return campaign(shift, Eigen::VectorXd::Zero(num_effects()), rng);
}

ToyCase Toy::distorted(Eigen::Index effect, double share, std::mt19937_64& rng) const {
  const Eigen::MatrixXd root = usual_covariance().llt().matrixL();
  const Eigen::VectorXd exact = effects_.col(effect);
  const Eigen::VectorXd direction =
      touched_rows(exact_, exact).cwiseProduct(root * normal_vector(exact.size(), rng));
  const auto length = [&](const Eigen::VectorXd& x) {
    return root.triangularView<Eigen::Lower>().solve(x).norm();
  };
  return campaign(exact + share * length(exact) / length(direction) * direction,
                  Eigen::VectorXd::Unit(num_effects(), effect), rng);
}

ToyAnswer answer_of(const Toy& toy, const Eigen::VectorXd& truth, const Diagnosis& diagnosis) {
  if (diagnosis.effects.empty()) {
    if (diagnosis.verdict == Verdict::set) return ToyAnswer::set;
    return diagnosis.verdict == Verdict::outside_catalogue ? ToyAnswer::other : ToyAnswer::nothing;
  }
  for (const NamedEffect& named : diagnosis.effects) {
    const auto found = std::ranges::find(toy.ids(), named.id);
    if (truth[found - toy.ids().begin()] == 0.0) return ToyAnswer::wrong;
  }
  return ToyAnswer::right;
}

ToyCase case_of_prior(const Toy& toy, std::mt19937_64& rng) {
  const auto num = static_cast<std::uint64_t>(toy.num_effects());
  const auto kind = rng() % 10;
  if (kind == 9) return toy.outside(rng);
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(toy.num_effects());
  const std::uint64_t first = rng() % num;
  const std::uint64_t second = (first + 1 + rng() % (num - 1)) % num;
  const double first_size = std::abs(standard_normal(rng));
  const double second_size = std::abs(standard_normal(rng));
  if (kind >= 4) sizes[static_cast<Eigen::Index>(first)] = first_size;
  if (kind == 8) sizes[static_cast<Eigen::Index>(second)] = second_size;
  return toy.hidden(sizes, rng);
}

void Reliability::add(const Toy& toy, const ToyCase& made, const Posterior& posterior) {
  for (Eigen::Index k = 0; k < toy.num_effects(); ++k) {
    const double p = posterior.inclusion[static_cast<Eigen::Index>(*toy.position(k))];
    for (std::size_t bin = 0; bin < num.size(); ++bin) {
      if (p < edges[bin] || p > edges[bin + 1]) continue;
      ++num[bin];
      num_true[bin] += made.truth[k] != 0.0 ? 1 : 0;
      sum[bin] += p;
    }
  }
}

}  // namespace tilth::test
