// SPDX-License-Identifier: Apache-2.0
// Leave one run out.
#include "core/evaluation/held_out.hpp"

#include <cassert>
#include <cmath>

#include "core/moments.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

/// Of every feature.
std::vector<Moments> scales(std::span<const Example> examples) {
  std::vector<Moments> result;
  for (std::size_t f = 0; f < examples.front().features.size(); ++f) {
    std::vector<double> values;
    for (const Example& example : examples) values.push_back(example.features[f]);
    result.push_back(moments(values));
  }
  return result;
}

void scale(std::vector<double>& features, std::span<const Moments> by) {
  for (std::size_t f = 0; f < features.size(); ++f) {
    const double sd = std::sqrt(by[f].variance);
    features[f] = sd > 0.0 ? (features[f] - by[f].mean) / sd : 0.0;
  }
}

std::vector<Example> all_but(std::span<const std::vector<Example>> runs, std::size_t left_out) {
  std::vector<Example> rest;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (run != left_out) rest.insert(rest.end(), runs[run].begin(), runs[run].end());
  }
  return rest;
}

}  // namespace

HeldOut held_out(std::span<const std::vector<Example>> runs, const LogisticConfig& config) {
  assert(runs.size() >= 2);
  HeldOut result;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    std::vector<Example> others = all_but(runs, run);
    const auto by = scales(others);
    for (Example& example : others) scale(example.features, by);
    const LogisticModel model = stepwise(others, config);
    result.times_selected.resize(by.size());
    for (const std::size_t f : model.selected) ++result.times_selected[f];
    auto& probabilities = result.probabilities.emplace_back();
    for (Example example : runs[run]) {
      scale(example.features, by);
      probabilities.push_back(probability(model, example.features));
    }
  }
  return result;
}

}  // namespace kidnapwatch::core::evaluation
