# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES
  experiments/angle_of_repose.cpp
  experiments/cone_penetration.cpp
  experiments/confined_compression.cpp
  experiments/curve_features.cpp
  experiments/cut_block.cpp
  experiments/direct_shear.cpp
  experiments/direct_tension.cpp
  experiments/drained_triaxial.cpp
  experiments/failed_runs.cpp
  experiments/effects.cpp
  experiments/field.cpp
  experiments/interface_shear.cpp
  experiments/packs.cpp
  experiments/settled_bed.cpp
  experiments/steady_window.cpp
  experiments/sweep_flow.cpp
  experiments/sweep_shape.cpp
  experiments/sweep_tillage.cpp
  experiments/tracers.cpp
  experiments/triaxial_features.cpp
  experiments/unconfined_compression.cpp
  experiments/vane_shear.cpp)
