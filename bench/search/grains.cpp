// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
#include "bench/search/grains.hpp"

#include <memory>
#include <string>

#include "calibrate/cli/dem_problem.hpp"
#include "calibrate/cli/run_config.hpp"
#include "calibrate/cli/target_choice.hpp"
#include "calibrate/soil_fit.hpp"

namespace tilth::bench {
namespace {

struct Laboratory {
  SoilData soil = load_soil(std::string(TILTH_SOURCE_DIR) + "/data/soils/loamy_sand");
  PackingStore packings{default_packing_folder()};
  RunContext context{packings, 1};
  Laboratory() {
    leave_out_sweep(soil);
    std::erase_if(soil.targets, &SoilTarget::holdout);
  }

  Eigen::MatrixXd all_parameters(const Eigen::MatrixXd& free) const {
    Eigen::MatrixXd all = nominal_values(soil).replicate(1, free.cols());
    const std::string names[] = {"bond_modulus_Pa", "bond_tensile_strength_Pa", "friction"};
    for (std::size_t k = 0; k < soil.parameters.size(); ++k)
      for (Eigen::Index j = 0; j < 3; ++j)
        if (soil.parameters[k].id == names[j]) all.row(static_cast<Eigen::Index>(k)) = free.row(j);
    return all;
  }
};

}  // namespace

std::function<std::vector<Evaluation>(const Eigen::MatrixXd& parameters,
                                      std::span<const std::uint64_t> seeds)>
loamy_sand_grains() {
  const auto laboratory = std::make_shared<Laboratory>();
  return [laboratory, simulate = dem_simulator(laboratory->soil, Fidelity::preview, laboratory->context)](
             const Eigen::MatrixXd& parameters, std::span<const std::uint64_t> seeds) {
    return simulate(laboratory->all_parameters(parameters), seeds);
  };
}

}  // namespace tilth::bench
