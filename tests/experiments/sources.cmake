# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES
  experiments/angle_of_repose.cpp
  experiments/confined_compression.cpp
  experiments/curve_features.cpp
  experiments/cut_block.cpp
  experiments/direct_shear.cpp
  experiments/drained_triaxial.cpp
  experiments/direct_tension.cpp
  experiments/failed_runs.cpp
  experiments/field.cpp
  experiments/interface_shear.cpp
  experiments/packs.cpp
  experiments/triaxial_features.cpp
  experiments/settled_bed.cpp
  experiments/unconfined_compression.cpp)
