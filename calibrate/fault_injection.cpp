// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/fault_injection.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tilth {

std::optional<Faults> faults_on_order() {
  const char* text = std::getenv("TILTH_FAULTS");
  if (!text || !*text) return std::nullopt;
  Faults faults;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const std::size_t at = word.find('=');
    const std::string name = word.substr(0, at), value = at == std::string::npos ? "" : word.substr(at + 1);
    if (name == "crash") faults.crash = std::stod(value);
    else if (name == "hang") faults.hang = std::stod(value);
    else if (name == "nan") faults.nan = std::stod(value);
    else if (name == "dir") faults.folder = value;
    else throw std::runtime_error("TILTH_FAULTS: unknown word " + word);
  }
  if (!std::filesystem::is_directory(faults.folder))
    throw std::runtime_error("TILTH_FAULTS: dir is no folder");
  return faults;
}

Faults::Kind Faults::next(const std::string& key) const {
  // the key is a hash: its first digits are as good as random
  const double u = static_cast<double>(std::stoul(key.substr(0, 7), nullptr, 16)) / 0x1p28;
  const Kind kind = u < crash               ? Kind::crash
                    : u < crash + hang       ? Kind::hang
                    : u < crash + hang + nan ? Kind::nan
                                             : Kind::none;
  if (kind == Kind::none || std::filesystem::exists(folder / key)) return Kind::none;
  std::ofstream(folder / key) << "had it\n";
  return kind;
}

void suffer(Faults::Kind fault, RunRecord& record) {
  if (fault == Faults::Kind::crash) std::raise(SIGSEGV);
  if (fault == Faults::Kind::hang) std::this_thread::sleep_for(std::chrono::hours(1));
  if (fault == Faults::Kind::nan)
    for (NamedNumber& f : record.features) f.value = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tilth
