# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES
  experiments/cone_penetration.cpp
  experiments/confined_compression.cpp
  experiments/curve_features.cpp
  experiments/direct_shear.cpp
  experiments/failed_runs.cpp
  experiments/field.cpp
  experiments/packs.cpp
  experiments/unconfined_compression.cpp
  experiments/vane_shear.cpp)
