// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Simulations to the noise floor: fit() beside plain NLopt and plain Ceres, on twins of a stand-in
// of the loamy-sand problem. Prints Markdown. From the repository's root:
//
//     build/release/bin/search_comparison          # 30 twins per data case
//     build/release/bin/search_comparison 5        # fewer
//     build/release/bin/search_comparison --grains [PART OF A NAME]...  # three twins of the DEM problem itself; 10 core-minutes per method
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "bench/search/comparison.hpp"
#include "bench/search/methods.hpp"
#include "bench/search/grains.hpp"
#include "bench/search/stand_in.hpp"
#include "calibrate/parallel.hpp"

namespace {

using namespace tilth;
using namespace tilth::bench;

struct Method {
  std::string name;
  bool is_plain = true;
  std::function<Outcome(const Twin&)> run;
};

struct Row {
  const Method* method = nullptr;
  Counts floor;
  Counts strict;
  Counts calls;  // to the floor
  Counts whole;  // simulations until the method ended by itself (fit) or was ended
  int num_returned_inside = 0;
};

// What the defaults' 32 design points cost a search that needs nothing else of them.
FitOptions small_design() {
  FitOptions options;
  options.num_design = 8;
  return options;
}

std::vector<Method> fits_on(const StandIn& stand_in) {
  return {
      {"`fit()`, defaults", false,
       [&](const Twin& twin) { return run_fit(stand_in, twin, FitOptions{}); }},
      {"`fit()`, quick preset", false,
       [&](const Twin& twin) { return run_fit(stand_in, twin, quick_fit_options()); }},
      {"`fit()`, 8 design points", false,
       [&](const Twin& twin) { return run_fit(stand_in, twin, small_design()); }}};
}

std::vector<Method> methods_on(const StandIn& stand_in) {
  std::vector<Method> methods = fits_on(stand_in);
  const std::vector<std::pair<std::string, NloptAlgorithm>> algorithms{
      {"NLopt BOBYQA", NloptAlgorithm::bobyqa},
      {"NLopt Sbplx", NloptAlgorithm::sbplx},
      {"NLopt CRS2", NloptAlgorithm::crs2},
      {"NLopt ISRES", NloptAlgorithm::isres}};
  for (const int num_packings : {1, 3}) {
    const std::string suffix =
        fmt::format(", {} packing{}", num_packings, num_packings > 1 ? "s" : "");
    for (const auto& [name, algorithm] : algorithms) {
      methods.push_back(
          {name + suffix, true, [&stand_in, algorithm, num_packings](const Twin& twin) {
             return run_nlopt(stand_in, twin, algorithm, num_packings);
           }});
    }
    for (const double step : {1e-6, 0.05}) {
      methods.push_back({fmt::format("Ceres, step {:g}{}", step, suffix), true,
                         [&stand_in, step, num_packings](const Twin& twin) {
                           return run_ceres(stand_in, twin, step, num_packings);
                         }});
    }
  }
  return methods;
}

Row run_method(const Method& method, const std::vector<Twin>& twins, std::size_t most_simulations) {
  Row row{&method, {}, {}, {}, {}, 0};
  std::vector<Outcome> outcomes(twins.size());
  parallel_for_each_index(twins.size(), threads_or_all(0),
                          [&](std::size_t i) { outcomes[i] = method.run(twins[i]); });
  for (const Outcome& outcome : outcomes) {
    row.floor.push_back(outcome.to_floor);
    row.strict.push_back(outcome.to_strict_floor);
    row.calls.push_back(outcome.calls_to_floor);
    row.whole.emplace_back(outcome.num_simulations);
    if (outcome.excess_returned != Outcome::not_set && outcome.excess_returned <= noise_floor)
      ++row.num_returned_inside;
  }
  fmt::print(stderr, "{}: median {:g}\n", method.name, median(row.floor, most_simulations));
  return row;
}

std::string floor_cells(const Counts& counts, std::size_t most_simulations) {
  return fmt::format("{:g} | {:g} | {}/{}", median(counts, most_simulations),
                     quantile(counts, 0.9, most_simulations), num_reached(counts), counts.size());
}

void print_table(const std::vector<Row>& rows, std::size_t most_simulations) {
  std::vector<Counts> plain;
  std::vector<Counts> plain_strict;
  for (const Row& row : rows) {
    if (!row.method->is_plain) continue;
    plain.push_back(row.floor);
    plain_strict.push_back(row.strict);
  }
  fmt::print(
      "| method | median | 90 % | reached | ratio to best plain (95 %) | calls "
      "| strict: median | 90 % | reached | ratio (95 %) |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Row& row : rows) {
    const Ratio ratio = ratio_to_best(row.floor, plain, most_simulations);
    const Ratio strict = ratio_to_best(row.strict, plain_strict, most_simulations);
    fmt::print("| {} | {} | {:.2f} ({:.2f}-{:.2f}) | {:g} | {} | {:.2f} ({:.2f}-{:.2f}) |\n",
               row.method->name, floor_cells(row.floor, most_simulations), ratio.value, ratio.lo95, ratio.hi95,
               median(row.calls, most_simulations), floor_cells(row.strict, most_simulations), strict.value,
               strict.lo95, strict.hi95);
  }
  for (const Row& row : rows) {
    if (row.method->is_plain) continue;
    fmt::print(
        "\n{}: whole fit {:g} simulations (median), {:g} (90 %); the point it returned was "
        "inside the floor in {} of {} twins.\n",
        row.method->name, median(row.whole, most_simulations),
        quantile(row.whole, 0.9, most_simulations), row.num_returned_inside, row.whole.size());
  }
}

void print_case(const std::string& name, const StandIn& stand_in, const Eigen::VectorXd& noise,
                int num_twins, const std::vector<Method>& methods) {
  std::vector<Twin> twins;
  for (int i = 0; i < num_twins; ++i) {
    twins.push_back(make_twin(stand_in, noise, static_cast<std::uint64_t>(i + 1)));
  }
  std::vector<Row> rows;
  for (const Method& method : methods)
    rows.push_back(run_method(method, twins, stand_in.most_simulations));
  fmt::print("\n{}\n\n", name);
  print_table(rows, stand_in.most_simulations);
}

// A tenth of the methods' cap and the plain methods that were any good on the stand-in, with ISRES.
std::vector<Method> methods_on_grains(const StandIn& stand_in) {
  std::vector<Method> methods = fits_on(stand_in);
  for (const auto& [name, algorithm] : {std::pair{"NLopt BOBYQA", NloptAlgorithm::bobyqa},
                                        {"NLopt Sbplx", NloptAlgorithm::sbplx},
                                        {"NLopt CRS2", NloptAlgorithm::crs2},
                                        {"NLopt ISRES", NloptAlgorithm::isres}})
    methods.push_back({fmt::format("{}, 1 packing", name), true, [&stand_in, algorithm](const Twin& twin) {
                         return run_nlopt(stand_in, twin, algorithm, 1);
                       }});
  for (const int num_packings : {1, 3})
    methods.push_back({fmt::format("Ceres, step 0.05, {} packing{}", num_packings, num_packings > 1 ? "s" : ""),
                       true, [&stand_in, num_packings](const Twin& twin) {
                         return run_ceres(stand_in, twin, 0.05, num_packings);
                       }});
  return methods;
}

// Only methods with one of `wanted` in their name; all if it is empty.
void compare_on_grains(StandIn stand_in, const Eigen::VectorXd& noise, std::span<char*> wanted) {
  stand_in.most_simulations = 150;
  stand_in.grains = loamy_sand_grains();
  std::vector<Method> methods = methods_on_grains(stand_in);
  std::erase_if(methods, [wanted](const Method& method) {
    return !wanted.empty() && std::none_of(wanted.begin(), wanted.end(), [&](const char* part) {
      return method.name.find(part) != std::string::npos;
    });
  });
  print_case("The grains themselves, laboratory data, three twins, at most 150 simulations", stand_in, noise, 3,
             methods);
}

void print_stand_in(const StandIn& stand_in) {
  fmt::print(
      "Stand-in: {} training runs.\n\n"
      "| feature | packing sd | chaos sd | leave-one-out Q2 |\n| --- | --- | --- | --- |\n",
      stand_in.num_training_runs);
  for (std::size_t k = 0; k < stand_in.targets.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    fmt::print("| {}{} | {:.3f} | {:.3f} | {:.3f} |\n",
               stand_in.targets[k].log_transform ? "ln " : "", stand_in.targets[k].name,
               stand_in.packing_sd[index], stand_in.chaos_sd[index],
               stand_in.emulators[k].leave_one_out().q2);
  }
}

}  // namespace

int main(int num_arguments, char** arguments) {
  const bool on_grains = num_arguments > 1 && std::string(arguments[1]) == "--grains";
  const int num_twins = num_arguments > 1 && !on_grains ? std::atoi(arguments[1]) : 30;
  if (num_twins < 1) {
    fmt::print(stderr, "usage: search_comparison [number of twins | --grains [PART OF A METHOD'S NAME]...]\n");
    return 2;
  }
  try {
    const StandIn stand_in =
        read_stand_in(TILTH_SOURCE_DIR "/bench/reference/loamy_sand_preview.csv");
    print_stand_in(stand_in);
    // 5 % on stresses and moduli, 1.5 deg on the friction angle: docs/twins.md.
    Eigen::VectorXd laboratory = Eigen::VectorXd::Constant(4, 0.05);
    laboratory[0] = 1.5 * std::numbers::pi / 180.0;
    if (on_grains) {
      compare_on_grains(stand_in, laboratory, std::span(arguments, static_cast<std::size_t>(num_arguments)).subspan(2));
      return 0;
    }
    Eigen::VectorXd literature(4);
    for (std::size_t k = 0; k < 4; ++k) {
      literature[static_cast<Eigen::Index>(k)] = stand_in.targets[k].sigma;
    }
    print_case("Laboratory data (5 %, 1.5 deg)", stand_in, laboratory, num_twins,
               methods_on(stand_in));
    print_case("Data of the shipped soil (its own sigma)", stand_in, literature, num_twins,
               methods_on(stand_in));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
