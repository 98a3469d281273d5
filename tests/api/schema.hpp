// SPDX-License-Identifier: Apache-2.0
// As much of JSON Schema 2020-12 as openapi.yaml and asyncapi.yaml use.
#pragma once

#include <algorithm>
#include <string>

#include "adapters/codecs/json.hpp"

namespace kidnapwatch::api {

using adapters::codecs::Json;

/// `json`, or what its $ref points to.
inline const Json& resolved(const Json& document, const Json& json) {
  if (!json.is_object() || !json.contains("$ref")) {
    return json;
  }
  const auto pointer = json["$ref"].get<std::string>().substr(1);
  return resolved(document, document.at(Json::json_pointer(pointer)));
}

inline bool is_of_type(const Json& value, const std::string& type) {
  return type == "integer" ? value.is_number_integer()
                           : type == (value.is_number() ? "number" : value.type_name());
}

std::string misfit(const Json& document, const Json& reference, const Json& value);

inline std::string object_misfit(const Json& document, const Json& schema, const Json& object) {
  const Json none = Json::object();
  const auto& properties = schema.contains("properties") ? schema["properties"] : none;
  for (const auto& name : schema.value("required", Json::array())) {
    if (!object.contains(name)) {
      return "lacks " + name.get<std::string>();
    }
  }
  for (const auto& [name, member] : object.items()) {
    const Json rest = schema.value("additionalProperties", Json(true));
    if (!properties.contains(name) && rest == false) {
      return "has " + name;
    }
    const auto& inner = properties.contains(name) ? properties[name] : rest;
    if (const auto wrong = misfit(document, inner, member); !wrong.empty()) {
      return std::string(name).append(": ").append(wrong);
    }
  }
  return "";
}

inline std::string number_misfit(const Json& schema, double value) {
  const bool fits = value >= schema.value("minimum", value) &&
                    value <= schema.value("maximum", value) &&
                    value > schema.value("exclusiveMinimum", value - 1.0) &&
                    value < schema.value("exclusiveMaximum", value + 1.0);
  return fits ? "" : "is out of range";
}

inline bool fits_any(const Json& document, const Json& schemas, const Json& value) {
  return std::ranges::any_of(schemas,
                             [&](const Json& one) { return misfit(document, one, value).empty(); });
}

/// What of `value` does not fit the schema; empty if all does.
inline std::string misfit(const Json& document, const Json& reference, const Json& value) {
  const Json& schema = resolved(document, reference);
  if (!schema.is_object()) {
    return "";
  }
  const Json types = schema.value("type", Json::array());
  const bool typed = types.is_string()
                         ? is_of_type(value, types)
                         : types.empty() || std::ranges::any_of(types, [&](auto& one) {
                             return is_of_type(value, one);
                           });
  if (!typed) {
    return value.dump() + " is not of type " + types.dump();
  }
  if (schema.contains("anyOf") && !fits_any(document, schema["anyOf"], value)) {
    return value.dump() + " fits none of " + schema["anyOf"].dump();
  }
  if (schema.contains("const") && value != schema["const"]) {
    return value.dump() + " is not " + schema["const"].dump();
  }
  if (schema.contains("enum") && std::ranges::find(schema["enum"], value) == schema["enum"].end()) {
    return value.dump() + " is none of " + schema["enum"].dump();
  }
  if (value.is_number()) {
    return number_misfit(schema, value.get<double>());
  }
  if (value.is_object()) {
    return object_misfit(document, schema, value);
  }
  if (value.is_array() && schema.contains("items")) {
    for (const auto& item : value) {
      if (auto wrong = misfit(document, schema["items"], item); !wrong.empty()) {
        return wrong;
      }
    }
  }
  return "";
}

}  // namespace kidnapwatch::api
