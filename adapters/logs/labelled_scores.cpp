// SPDX-License-Identifier: Apache-2.0
// Reads labelled scores from CSV.
#include "adapters/logs/labelled_scores.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "adapters/logs/lines.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

constexpr std::string_view kPrefix = "field.";
constexpr std::string_view kLabel = "field.label";

std::vector<std::string_view> columns(std::string_view line) {
  std::vector<std::string_view> found;
  for (;;) {
    const std::size_t comma = line.find(',');
    found.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return found;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> finite(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// Nothing unless there are `columns` of them, and numbers from the label on.
std::optional<LabelledRow> row(std::string_view line, std::size_t all, std::size_t label) {
  const auto words = columns(line);
  if (words.size() != all) return std::nullopt;
  LabelledRow result;
  for (std::size_t i = label; i < all; ++i) {
    const auto value = finite(words[i]);
    if (!value) return std::nullopt;
    if (i == label) {
      result.lost = *value > 0.5;
    } else {
      result.scores.push_back(*value);
    }
  }
  return result;
}

}  // namespace

LabelledScores read_labelled_scores(const std::filesystem::path& file) {
  Lines lines(file);
  if (!lines.next()) throw core::BadInput(file.string(), "empty");
  const std::string head(lines.text());
  const auto names = columns(head);
  const auto label = std::ranges::find(names, kLabel);
  if (label == names.end()) throw core::BadInput(file.string(), "no column field.label");
  LabelledScores result;
  for (auto name = label + 1; name != names.end(); ++name) {
    result.names.emplace_back(name->starts_with(kPrefix) ? name->substr(kPrefix.size()) : *name);
  }
  while (lines.next()) {
    auto found = row(lines.text(), names.size(), static_cast<std::size_t>(label - names.begin()));
    if (found) {
      result.rows.push_back(std::move(*found));
    } else {
      ++result.skipped_lines;
    }
  }
  if (result.rows.empty()) throw core::BadInput(file.string(), "no row");
  return result;
}

}  // namespace kidnapwatch::adapters::logs
