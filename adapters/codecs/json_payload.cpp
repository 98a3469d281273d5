// SPDX-License-Identifier: Apache-2.0
// The values of which the fast path's JSON messages are made.
#include "adapters/codecs/json_payload.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

[[nodiscard]] std::int64_t integer(ondemand::value value, std::string_view field) {
  const ondemand::json_type type = value.type();
  std::int64_t number = 0;
  if (type != ondemand::json_type::number || value.get_int64().get(number) != simdjson::SUCCESS) {
    throw_wrong_type(field, "a whole number");
  }
  return number;
}

}  // namespace

double number(ondemand::value value, std::string_view field) {
  double parsed = 0.0;
  if (value.get_double().get(parsed) == simdjson::SUCCESS) {
    return parsed;
  }
  const ondemand::json_type type = value.type();
  if (type == ondemand::json_type::number) {
    throw simdjson::simdjson_error(simdjson::NUMBER_ERROR);  // perhaps -Infinity
  }
  if (type == ondemand::json_type::string) {
    if (const auto special = nonfinite(value.get_string())) {
      return *special;
    }
  }
  throw_wrong_type(field, "a number");
}

ondemand::object object(ondemand::value value, std::string_view field) {
  const ondemand::json_type type = value.type();
  if (type != ondemand::json_type::object) {
    throw_wrong_type(field, "an object");
  }
  return value.get_object();
}

core::Stamp stamp(ondemand::value value, std::string_view field) {
  StampFields fields;
  for (auto entry : object(value, field)) {
    const std::string_view key = entry.unescaped_key();
    if (StampFields::knows(key)) {
      fields.set(key, integer(entry.value(), field));
    }
  }
  return fields.stamp();
}

std::optional<core::Stamp> header_stamp(ondemand::value value) {
  std::optional<core::Stamp> found;
  for (auto entry : object(value, "header")) {
    const std::string_view key = entry.unescaped_key();
    if (key == "stamp") {
      found = stamp(entry.value(), "header.stamp");
    }
  }
  return found;
}

}  // namespace kidnapwatch::adapters::codecs
