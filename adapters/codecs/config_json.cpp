// SPDX-License-Identifier: Apache-2.0
// One list of members per struct, walked both to write and to read it.
#include "adapters/codecs/config_json.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/names.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

template <typename Config, typename Of>
concept MaybeConst = std::same_as<std::remove_const_t<Config>, Of>;

template <typename Visit, MaybeConst<core::DissimilarityConfig> Config>
void each_member(Config& config, Visit& visit) {
  visit("dimension", config.dimension);
  visit("gate", config.gate);
  visit("variance_test", config.variance_test);
  visit("significance", config.significance);
  visit("invalid", config.invalid);
  visit("precision", config.precision);
}

template <typename Visit, MaybeConst<core::CalibrationConfig> Config>
void each_member(Config& config, Visit& visit) {
  visit("false_alarm_rate", config.false_alarm_rate);
  visit("warmup_pairs", config.warmup_pairs);
  visit("window_pairs", config.window_pairs);
}

template <typename Visit, MaybeConst<core::Pose> Config>
void each_member(Config& config, Visit& visit) {
  visit("x_m", config.x_m);
  visit("y_m", config.y_m);
  visit("theta_rad", config.theta_rad);
}

template <typename Visit, MaybeConst<core::MotionConfig> Config>
void each_member(Config& config, Visit& visit) {
  visit("threshold_min", config.threshold_min);
  visit("sensor", config.sensor);
}

template <typename Visit, MaybeConst<core::DetectionConfig> Config>
void each_member(Config& config, Visit& visit) {
  visit("alarm", config.alarm);
  visit("dissimilarity", config.dissimilarity);
  visit("motion", config.motion);
  visit("calibration", config.calibration);
  visit("threshold", config.threshold);
  visit("detectors", config.detectors);
  visit("stale_after_s", config.stale_after_s);
  visit("resolve_after_s", config.resolve_after_s);
  visit("resync_scans", config.resync_scans);
}

using Names = std::string_view;
constexpr std::array<Names, 4> names(core::AlarmBy) {
  return {"motion_consistency", "qs2ddtw", "either", "both"};
}
constexpr std::array<Names, 2> names(core::Dimension) { return {"ranges", "points"}; }
constexpr std::array<Names, 4> names(core::Gate) {
  return {"paper", "homogeneous", "never", "always"};
}
constexpr std::array<Names, 3> names(core::VarianceTest) {
  return {"bartlett", "levene", "brown_forsythe"};
}
constexpr std::array<Names, 2> names(core::InvalidPolicy) { return {"drop", "clamp"}; }
constexpr std::array<Names, 2> names(core::Precision) { return {"f32", "f64"}; }

template <typename Value>
concept Enum = std::is_enum_v<Value>;

template <typename Value>
concept Struct = std::is_class_v<Value>;

/// Writes the members of one struct into `object`.
struct Writer {
  Json& object;

  void operator()(const char* key, double value) { object[key] = value; }
  void operator()(const char* key, std::size_t value) { object[key] = value; }
  void operator()(const char* key, const std::optional<double>& value) {
    object[key] = value ? Json(*value) : Json(nullptr);
  }
  void operator()(const char* key, const std::vector<std::string>& texts) { object[key] = texts; }
  void operator()(const char* key, const Enum auto& value) {
    object[key] = names(value).at(static_cast<std::size_t>(value));
  }
  void operator()(const char* key, const Struct auto& config) {
    Writer inner{object[key] = Json::object()};
    each_member(config, inner);
  }
};

/// Reads the members of one struct that `object` has, and remembers which it may have.
class Reader {
 public:
  Reader(const Json& object, std::string path) : object_(object), path_(std::move(path)) {
    if (!object.is_object()) {
      throw core::BadInput(path_.empty() ? "body" : path_, "must be an object");
    }
  }

  void operator()(const char* key, auto& value) {
    known_.emplace_back(key);
    if (const auto found = object_.find(key); found != object_.end()) {
      read(*found, path_of(key), value);
    }
  }

  void refuse_unknown() const {
    for (const auto& [key, value] : object_.items()) {
      if (std::ranges::find(known_, key) == known_.end()) {
        throw core::BadInput(path_of(key), "is not a known member");
      }
    }
  }

 private:
  [[nodiscard]] std::string path_of(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
  }

  static void read(const Json& json, const std::string& path, double& value) {
    if (!json.is_number()) {
      throw core::BadInput(path, "must be a number");
    }
    value = json.get<double>();
  }

  static void read(const Json& json, const std::string& path, std::size_t& value) {
    if (!json.is_number_unsigned()) {
      throw core::BadInput(path, "must be an integer, at least 0");
    }
    value = json.get<std::size_t>();
  }

  static void read(const Json& json, const std::string& path, std::optional<double>& value) {
    if (json.is_null()) {
      value.reset();
    } else {
      read(json, path, value.emplace());
    }
  }

  static void read(const Json& json, const std::string& path, std::vector<std::string>& texts) {
    if (!json.is_array() || !std::ranges::all_of(json, &Json::is_string)) {
      throw core::BadInput(path, "must be a list of texts");
    }
    texts = json.get<std::vector<std::string>>();
  }

  static void read(const Json& json, const std::string& path, Enum auto& value) {
    const std::string text = json.is_string() ? json.get<std::string>() : std::string();
    value = core::named<std::remove_reference_t<decltype(value)>>(names(value), text, path);
  }

  static void read(const Json& json, const std::string& path, Struct auto& config) {
    Reader inner(json, path);
    each_member(config, inner);
    inner.refuse_unknown();
  }

  const Json& object_;
  std::string path_;
  std::vector<std::string> known_;
};

const Json& member(const Json& object, const std::string& key) {
  static const Json kNothing = Json::object();
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

void note_origins(const Json& effective, const Json& fleet, const Json& robot,
                  const std::string& path, Json& origins) {
  for (const auto& [key, value] : effective.items()) {
    if (value.is_object()) {
      note_origins(value, member(fleet, key), member(robot, key), path + key + ".", origins);
    } else {
      const char* fallback = fleet.contains(key) ? "fleet" : "default";
      origins[path + key] = robot.contains(key) ? "robot" : fallback;
    }
  }
}

}  // namespace

Json json(const core::DetectionConfig& config) {
  Json object = Json::object();
  Writer writer{object};
  each_member(config, writer);
  return object;
}

core::DetectionConfig detection_config(const Json& object, const core::DetectionConfig& base) {
  core::DetectionConfig config = base;
  Reader reader(object, "");
  each_member(config, reader);
  reader.refuse_unknown();
  return config;
}

Json config_origins(const core::DetectionConfig& effective, const Json& fleet, const Json& robot) {
  Json origins = Json::object();
  note_origins(json(effective), fleet, robot, "", origins);
  return origins;
}

}  // namespace kidnapwatch::adapters::codecs
