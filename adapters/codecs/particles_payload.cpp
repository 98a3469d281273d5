// SPDX-License-Identifier: Apache-2.0
// nav2_msgs/ParticleCloud and its short forms.
#include "adapters/codecs/particles_payload.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "adapters/codecs/cbor_reader.hpp"
#include "adapters/codecs/json_payload.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using Major = CborReader::Major;
using Head = CborReader::Head;

/// The weights as they come, and what makes them unusable.
class Weights {
 public:
  void add(double weight) {
    if (!(std::isfinite(weight) && weight >= 0.0)) {
      throw_wrong_type("weight", "finite and at least 0");
    }
    if (weights_.size() == kMaxParticles) {
      throw core::BadScan(core::Outcome::too_large, "particles",
                          "are more than " + std::to_string(kMaxParticles));
    }
    weights_.push_back(weight);
  }
  void add(const std::optional<double>& weight) {
    if (!weight) throw_missing("weight");
    add(*weight);
  }

  [[nodiscard]] std::vector<double> all() && {
    if (weights_.empty()) throw_missing("particles");
    return std::move(weights_);
  }

 private:
  std::vector<double> weights_;
};

// --- JSON

[[nodiscard]] ondemand::array array(ondemand::value value, std::string_view field) {
  if (value.type() != ondemand::json_type::array) {
    throw_wrong_type(field, "an array");
  }
  return value.get_array();
}

[[nodiscard]] std::optional<double> weight_of(ondemand::value particle) {
  std::optional<double> weight;
  for (auto entry : object(particle, "particles")) {
    const std::string_view key = entry.unescaped_key();
    if (key == "weight") weight = number(entry.value(), "weight");
  }
  return weight;
}

void read(ondemand::object& message, Weights& weights) {
  for (auto entry : message) {
    const std::string_view key = entry.unescaped_key();
    if (key == "particles") {
      for (auto particle : array(entry.value(), key)) weights.add(weight_of(particle.value()));
    } else if (key == "weights") {
      for (auto weight : array(entry.value(), key)) weights.add(number(weight.value(), key));
    }
  }
}

// --- CBOR

/// Reads the weights in the order in which they come.
class CborWeights {
 public:
  explicit CborWeights(std::string_view bytes) : cbor_(bytes) {}

  void read(Weights& weights) {
    const Head message = untagged();
    if (message.major == Major::array) {
      read_numbers(message, weights);
    } else if (message.major == Major::map) {
      cbor_.for_each_entry(message, [&](std::string_view key) { read_field(key, weights); });
    } else {
      throw_malformed("payload", "is neither an array nor a map");
    }
    if (!cbor_.at_end()) {
      throw_malformed("payload", "goes on after its end");
    }
  }

 private:
  void read_field(std::string_view key, Weights& weights) {
    const Head value = untagged();
    if (key == "weights") {
      read_numbers(require(value, Major::array, "weights", "an array"), weights);
    } else if (key == "particles") {
      cbor_.for_each(require(value, Major::array, "particles", "an array"),
                     [&] { weights.add(weight_of_particle()); });
    } else {
      cbor_.skip(value);
    }
  }

  void read_numbers(const Head& array, Weights& weights) {
    cbor_.for_each(array, [&] { weights.add(number_of("weights")); });
  }

  [[nodiscard]] std::optional<double> weight_of_particle() {
    std::optional<double> weight;
    const Head particle = require(untagged(), Major::map, "particles", "maps");
    cbor_.for_each_entry(particle, [&](std::string_view key) {
      if (key == "weight") {
        weight = number_of("weight");
      } else {
        cbor_.skip(cbor_.head());
      }
    });
    return weight;
  }

  [[nodiscard]] double number_of(std::string_view field) {
    const auto value = number(untagged());
    if (!value) {
      throw_wrong_type(field, "a number");
    }
    return *value;
  }

  [[nodiscard]] static Head require(const Head& head, Major major, std::string_view field,
                                    std::string_view type) {
    if (head.major != major) {
      throw_wrong_type(field, type);
    }
    return head;
  }

  [[nodiscard]] Head untagged() {
    Head head = cbor_.head();
    while (head.major == Major::tag) {
      head = cbor_.head();
    }
    return head;
  }

  CborReader cbor_;
};

/// The first byte of JSON that is no space; 0 if there is none.
[[nodiscard]] char first_of(std::string_view text) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  return start == std::string_view::npos ? '\0' : text[start];
}

}  // namespace

struct ParticlesDecoder::Json {
  JsonPayload payload;
};

ParticlesDecoder::ParticlesDecoder(std::size_t max_payload_bytes)
    : max_payload_bytes_(max_payload_bytes), json_(std::make_unique<Json>()) {}
ParticlesDecoder::~ParticlesDecoder() = default;
ParticlesDecoder::ParticlesDecoder(ParticlesDecoder&&) noexcept = default;
ParticlesDecoder& ParticlesDecoder::operator=(ParticlesDecoder&&) noexcept = default;

std::vector<double> ParticlesDecoder::decode(std::string_view payload) {
  if (payload.size() > max_payload_bytes_) {
    throw core::BadScan(core::Outcome::too_large, "payload",
                        "has more than " + std::to_string(max_payload_bytes_) + " bytes");
  }
  Weights weights;
  const char first = first_of(payload);
  if (first == '{') {
    json_->payload.read(payload, [&](ondemand::object& message) {
      weights = {};
      read(message, weights);
    });
  } else if (first == '[') {  // the fast path reads objects
    const std::string message = R"({"weights":)" + std::string(payload) + "}";
    json_->payload.read(message, [&](ondemand::object& wrapped) {
      weights = {};
      read(wrapped, weights);
    });
  } else {
    CborWeights(payload).read(weights);
  }
  return std::move(weights).all();
}

}  // namespace kidnapwatch::adapters::codecs
