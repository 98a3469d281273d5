// SPDX-License-Identifier: Apache-2.0
// Rows of the golden files: columns parted by commas, numbers in them by blanks.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace kidnapwatch::core::evaluation {

inline std::vector<std::vector<std::string>> golden_rows(const std::string& name) {
  std::ifstream file(std::string(KW_GOLDEN_DIR "/") + name);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream columns(line);
    auto& row = rows.emplace_back();
    for (std::string column; std::getline(columns, column, ',');) row.push_back(column);
  }
  return rows;
}

inline std::vector<double> numbers(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> values;
  for (double value = 0.0; words >> value;) values.push_back(value);
  return values;
}

}  // namespace kidnapwatch::core::evaluation
