# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES
  experiments/confined_compression.cpp
  experiments/curve_features.cpp
  experiments/direct_shear.cpp
  experiments/drained_triaxial.cpp
  experiments/failed_runs.cpp
  experiments/field.cpp
  experiments/packs.cpp
  experiments/triaxial_features.cpp
  experiments/unconfined_compression.cpp)
