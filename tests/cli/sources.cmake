# SPDX-License-Identifier: BSD-3-Clause
list(APPEND TILTH_TEST_SOURCES cli/export.cpp)
list(APPEND TILTH_TEST_SOURCES cli/export_peers.cpp)
