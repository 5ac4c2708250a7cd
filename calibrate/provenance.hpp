// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: 2026 the Tilth authors
// Where a number comes from.
#pragma once

namespace tilth {

/// Best first.
///
/// - measured: read off an instrument on this soil, with a known protocol
/// - literature: printed in a source for a comparable soil or a class of soils
/// - derived: computed from other numbers
/// - synthetic: made by a model; good for tests of the program, says nothing about soil
enum class Provenance { measured, literature, derived, synthetic };

}  // namespace tilth
