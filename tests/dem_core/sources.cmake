# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES
  support/scene.cpp
  dem_core/bond_law.cpp
  dem_core/bond_rotation.cpp
  dem_core/bond_strength.cpp
  dem_core/bonded_cylinder.cpp
  dem_core/cantilever.cpp
  dem_core/collision.cpp
  dem_core/conservation.cpp
  dem_core/contact_law.cpp
  dem_core/damping.cpp
  dem_core/diagnostics.cpp
  dem_core/free_flight.cpp
  dem_core/incline.cpp
  dem_core/invariance.cpp
  dem_core/lanes.cpp
  dem_core/mesh.cpp
  dem_core/model.cpp
  dem_core/neighbours.cpp
  dem_core/packing.cpp
  dem_core/packing_store.cpp
  dem_core/rolling.cpp
  dem_core/settled_bed.cpp
  dem_core/snapshot.cpp
  dem_core/time_step.cpp
  dem_core/tools.cpp
  dem_core/walls.cpp)
