// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// One deck per target code: texts of all files, nothing written.
#pragma once

#include "calibrate/cli/export_specimen.hpp"

namespace tilth {

/// YADE: unconfined compression, bonded.
std::vector<ExportFile> yade_files(const ExportSource& source, const ExportSpecimen& specimen);

/// PFC3D: the same; never run by us.
std::vector<ExportFile> pfc_files(const ExportSource& source, const ExportSpecimen& specimen);

/// LAMMPS and LIGGGHTS: confined compression without bonds.
std::vector<ExportFile> lammps_files(const ExportSource& source, const ExportSpecimen& specimen);
std::vector<ExportFile> liggghts_files(const ExportSource& source, const ExportSpecimen& specimen);

}  // namespace tilth
