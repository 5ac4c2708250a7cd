// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// A copy of a shipped soil folder that a test may spoil; removed at the end.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tilth::soil_test {

inline std::filesystem::path data_root() {
  return std::filesystem::path(TILTH_SOURCE_DIR) / "data";
}

inline std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// True when one sentence holds all parts.
inline bool mentions(const std::vector<std::string>& sentences,
                     const std::vector<std::string>& parts) {
  return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& sentence) {
    return std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
      return sentence.find(part) != std::string::npos;
    });
  });
}

/// Copies a shipped soil without its tracers: most tests are about the rows of measurements.csv.
inline void copy_without_tracers(const std::string& soil, const std::filesystem::path& to) {
  std::filesystem::copy(data_root() / "soils" / soil, to);
  std::filesystem::remove(to / "tracers.csv");
}

class SoilFolder {
 public:
  /// The shipped soil without its tracers. `test_name` and the process keep tests that run side by side apart.
  SoilFolder(const std::string& soil, const std::string& test_name)
      : root_(std::filesystem::temp_directory_path() / ("tilth_soil_test_" + test_name + "_" + std::to_string(::getpid()))),
        path_(root_ / soil) {
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
    copy_without_tracers(soil, path_);
  }
  ~SoilFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  SoilFolder(const SoilFolder&) = delete;
  SoilFolder& operator=(const SoilFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Replaces the first occurrence; a text that is not there is an error of the test.
  void replace(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read_text(path_ / file);
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("'" + from + "' is not in " + file);
    write_text(path_ / file, text.replace(at, from.size(), to));
  }

  void append(const std::string& file, const std::string& line) {
    write_text(path_ / file, read_text(path_ / file) + line + "\n");
  }

 private:
  std::filesystem::path root_;
  std::filesystem::path path_;
};

}  // namespace tilth::soil_test
