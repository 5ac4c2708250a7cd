// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// The words a soil folder may use: tests, their observables with plausible ranges, parameters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tilth {

/// What a row of conditions.csv must give for an observable to be defined.
enum class ConditionNeed {
  none,
  one_normal_stress,      ///< normal_stress_Pa with one number
  three_normal_stresses,  ///< normal_stress_Pa with at least three different numbers
  one_cell_pressure,      ///< cell_pressure_Pa with one number
  two_cell_pressures,     ///< cell_pressure_Pa with at least two different numbers
  load_stresses,          ///< load_from_stress_Pa < load_to_stress_Pa
  unload_stresses         ///< load_to_stress_Pa > unload_to_stress_Pa
};

/// A column of conditions.csv.
struct KnownConditionColumn {
  std::string name;              ///< ends in its SI unit
  double plausible_lower = 0.0;  ///< values lie inside; outside is taken for a wrong unit
  double plausible_upper = 0.0;
  bool takes_list = false;       ///< several numbers with ';' between them
};

/// A number a virtual test can give.
struct KnownObservable {
  std::string test_id;
  std::string observable_id;     ///< ends in its SI unit
  double plausible_lower = 0.0;  ///< soil values lie inside; outside is taken for a wrong unit
  double plausible_upper = 0.0;
  ConditionNeed need = ConditionNeed::none;
  std::vector<std::string> needed_columns = {};  ///< of conditions.csv, whatever their value
};

/// A parameter of the model, as data: what it is called and where it makes sense.
struct KnownParameter {
  std::string id;
  double lower = 0.0;  ///< physically possible range
  double upper = 0.0;
};

/// A column of measured curves.
struct KnownCurveColumn {
  std::string name;  ///< ends in its SI unit
  double plausible_lower = 0.0;
  double plausible_upper = 0.0;
};

/// What a curve of curves.csv must look like.
struct KnownCurve {
  std::string test_id;
  std::vector<KnownCurveColumn> columns;  ///< the first must increase from row to row
  std::string held_column;                ///< is held constant in the test ...
  std::string held_at;                    ///< ... at this column of conditions.csv
};

struct SoilVocabulary {
  std::vector<KnownObservable> observables;
  std::vector<KnownParameter> parameters;
  std::vector<KnownConditionColumn> condition_columns;
  std::vector<KnownCurve> curves;

  std::vector<std::string> test_ids() const;  ///< each once
  std::vector<std::string> observable_ids(std::string_view test_id) const;
  std::vector<std::string> parameter_ids() const;
  const KnownObservable* observable(std::string_view test_id, std::string_view observable_id) const;
  const KnownParameter* parameter(std::string_view id) const;
};

/// The words of this version, the parameters of the catalogue of effects among them.
const SoilVocabulary& soil_vocabulary();

/// True when the name ends in a known SI unit suffix or has none that looks like a unit:
/// "modulus_Pa" and "friction" pass, "modulus_kPa", "angle_deg" and "radius_mm" do not.
/// @param reason  when false: the sentence, with the suffix to use
bool has_si_name(std::string_view name, std::string* reason = nullptr);

/// What a value far outside its plausible range may have been: "; given in kPa? write 2110 Pa".
/// Empty when no usual unit explains it. The SI unit is taken from the end of `name`.
std::string unit_hint(std::string_view name, double value, double lower, double upper);

}  // namespace tilth
