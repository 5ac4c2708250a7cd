// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One soil as data: its state, the tests it was (or is said to have been) put to, the numbers to
// reproduce with their provenance, and the parameters of the model. See docs/data.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/config_error.hpp"
#include "calibrate/soil_vocabulary.hpp"
#include "calibrate/targets.hpp"

namespace tilth {

/// The words of `Provenance` (calibrate/targets.hpp), best first; a better one supersedes a worse
/// one.
///
/// - measured: read off an instrument on this soil, with a known protocol
/// - literature: printed in a source for a comparable soil or a class of soils
/// - derived: computed from other numbers; `locator` holds formula and inputs
/// - synthetic: made by a model; tests the program, says nothing about soil
const std::vector<std::string>& provenance_words();
std::optional<Provenance> provenance_from_word(std::string_view word);

/// How `sigma` of a target is to be read; `sigma_of` turns the first three into SI units.
///
/// - absolute: in the unit of the value
/// - relative: share of |value|
/// - floor: in the unit of the value; the noise of the simulation may raise it, never lower it
/// - log: standard deviation of ln(value); the residual is ln(simulated / value) / sigma
enum class SigmaKind { absolute, relative, floor, log };

const std::vector<std::string>& sigma_kind_words();  ///< in the order of the enumerators

struct Origin {
  Provenance provenance = Provenance::synthetic;
  std::string source;   ///< who says so: paper, data set, or "computed from entries of this folder"
  std::string locator;  ///< where in the source; for derived numbers formula and inputs
};

/// One fact about the state of the soil, from soil.json.
struct StateQuantity {
  std::string quantity;  ///< ends in its SI unit; no suffix: dimensionless
  double value = 0.0;
  std::optional<double> sigma;         ///< standard deviation, > 0; absent: the source states none
  std::optional<double> lower, upper;  ///< or an interval, lower < upper
  Origin origin;
};

/// Numbers of one column of conditions.csv.
struct ConditionNumbers {
  std::string column;          ///< ends in its SI unit: "normal_stress_Pa"
  std::vector<double> values;  ///< never empty; more than one only where the column takes a list
};

/// One row of conditions.csv: how a test was run. A column that is named like a setting of a virtual
/// test is that setting; an absent number is not known, or the test's own default holds.
struct TestCondition {
  std::string id;
  std::vector<ConditionNumbers> numbers;
  std::string note;
  std::size_t line = 0;

  /// Numbers of a column; empty when absent.
  std::vector<double> values(std::string_view column) const;
  /// The number of a column that holds exactly one.
  std::optional<double> number(std::string_view column) const;
};

/// One row of measurements.csv.
struct SoilTarget {
  std::string test_id;        ///< "direct_shear"
  std::string observable_id;  ///< "cohesion_Pa"
  std::string condition_id;
  std::string x_id;         ///< for points of a curve: name of the abscissa, with unit; else ""
  std::optional<double> x;  ///< for points of a curve
  double value = 0.0;       ///< in the unit that ends observable_id
  double sigma = 0.0;       ///< > 0, read according to sigma_kind
  SigmaKind sigma_kind = SigmaKind::absolute;
  std::string replicate_id;
  double weight = 1.0;   ///< what matters to the user; noise belongs in sigma
  bool holdout = false;  ///< true: never enters the fit, only checks it
  Origin origin;
  std::vector<std::string> observation_groups;  ///< the independent numbers it was computed from
  std::size_t line = 0;                         ///< in measurements.csv
};

/// One measured curve of curves.csv, one reading per row.
struct MeasuredCurve {
  std::string test_id;
  std::string condition_id;
  std::vector<std::string> columns;  ///< end in their SI units; see SoilVocabulary::curves
  std::vector<std::vector<double>> rows;
  std::size_t line = 0;  ///< of the first row
};

/// Standard deviation in the unit of the value: sigma, sigma |value|, sigma, or for log
/// |value| sinh(sigma), half the distance from value e^-sigma to value e^sigma.
double sigma_of(const SoilTarget& target);

/// "direct_shear/cohesion_Pa/shear_wet", with "@x" for points of a curve.
std::string label(const SoilTarget& target);

/// A row set aside because the same observable under the same condition has a better provenance.
struct SupersededTarget {
  SoilTarget target;
  std::string reason;  ///< one sentence with both lines
};

enum class PriorKind { none, uniform, normal, log_normal };

/// parameter = factor * other parameter.
struct Tie {
  double factor = 1.0;
  std::string parameter_id;
};

/// "1.5*bond_tensile_strength_Pa", "bond_modulus_Pa", blanks allowed; empty when it is neither.
std::optional<Tie> parse_tie(std::string_view text);

/// One row of parameters.csv.
struct SoilParameter {
  std::string id;  ///< ends in its SI unit
  bool log_scale = false;
  double lower = 0.0;  ///< lower < upper where estimated, lower <= nominal <= upper
  double upper = 0.0;
  double nominal = 0.0;  ///< start of the fit, or the fixed value; a tied one follows its master
  bool estimate = false;
  PriorKind prior = PriorKind::none;
  double prior_p1 = 0.0;  ///< uniform: lower; normal: mean; log_normal: median
  double prior_p2 = 0.0;  ///< uniform: upper; normal: deviation; log_normal: deviation of ln
  std::string group;      ///< "contact", "bond", "numerical": for the reports
  std::optional<Tie> tied_to;
  std::string role;  ///< "calibrated" or "fixed"
  std::size_t line = 0;
};

struct SoilData {
  std::filesystem::path folder;
  std::string id;    ///< name of the folder, "loamy_sand"
  std::string name;  ///< for people, "Loamy sand"
  std::string site;  ///< where it is from, or of what it is a proxy
  std::vector<StateQuantity> state;
  std::vector<TestCondition> conditions;
  std::vector<SoilTarget> targets;  ///< in force, hold-outs included, in the order of the file
  std::vector<SupersededTarget> superseded;
  std::vector<SoilParameter> parameters;
  std::vector<MeasuredCurve> curves;  ///< empty where the folder has no curves.csv
  std::vector<std::string> warnings;  ///< usable, but the report must say so

  const TestCondition* condition(std::string_view condition_id) const;  ///< null when absent
  const SoilParameter* parameter(std::string_view parameter_id) const;  ///< null when absent
  const StateQuantity* quantity(std::string_view quantity) const;       ///< null when absent
  const MeasuredCurve* curve(std::string_view test_id, std::string_view condition_id) const;  ///< or null
};

/// Number of independent observations among the targets of the fit (hold-outs do not count).
///
/// Each target is computed from its observation groups; a group is one independent number. The
/// result is the structural rank of that relation: the largest number of targets that can each be
/// given a group of their own. Replicates and numbers derived from one another thus count once.
std::size_t num_independent_observations(const std::vector<SoilTarget>& targets);

/// Parameters that are estimated and not tied.
std::size_t num_free_parameters(const std::vector<SoilParameter>& parameters);

/// Share of the targets of the fit (hold-outs left out) that are measured, in [0, 1]; 0 for none.
double measured_share(const std::vector<SoilTarget>& targets);

/// Reads soil.json, conditions.csv, measurements.csv, parameters.csv and, where there are such files,
/// curves.csv and tracers.csv of a folder.
///
/// Rows of lower provenance are superseded: of all rows with the same testId, observableId,
/// conditionId, xId and x only those of the best provenance stay in `targets`.
///
/// @throws ConfigError with every problem of all four files
SoilData load_soil(const std::filesystem::path& folder,
                   const SoilVocabulary& vocabulary = soil_vocabulary());

/// The sentences `load_soil` would throw; empty when the folder is usable. Reads, writes nothing.
std::vector<std::string> problems_of_soil_folder(
    const std::filesystem::path& folder, const SoilVocabulary& vocabulary = soil_vocabulary());

/// A number of the soil's state, nothing where soil.json does not have it.
std::optional<double> state_value(const SoilData& soil, std::string_view quantity);

/// Names of the soils under `<data_root>/soils`, sorted: each folder that holds a soil.json.
std::vector<std::string> known_soils(const std::filesystem::path& data_root);

/// `<data_root>/soils/<name>`.
/// @throws ConfigError "unknown soil 'loamysand': known are ...; did you mean loamy_sand?"
std::filesystem::path soil_folder(const std::filesystem::path& data_root, std::string_view name);

}  // namespace tilth
