// SPDX-License-Identifier: Apache-2.0
// Particle weights in every form, and every way to be wrong.
#include "adapters/codecs/particles_payload.hpp"

#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "adapters/codecs/json.hpp"
#include "core/outcome.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using Weights = std::vector<double>;

// What rosbridge sends of nav2_msgs/ParticleCloud.
constexpr const char* kCloud =
    R"({"header":{"stamp":{"sec":5,"nanosec":6},"frame_id":"map"},"particles":[)"
    R"({"pose":{"position":{"x":1,"y":2,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}},)"
    R"("weight":0.25},{"pose":{"position":{"x":1,"y":3,"z":0}},"weight":0.75}]})";

Weights decoded(std::string_view payload) { return ParticlesDecoder(10'000).decode(payload); }

std::string as_cbor(const char* json_text) {
  const auto bytes = Json::to_cbor(Json::parse(json_text));
  return {bytes.begin(), bytes.end()};
}

std::string complaint(std::string_view payload) {
  try {
    (void)decoded(payload);
    return "decoded";
  } catch (const core::BadScan& bad) {
    return std::string(core::name(bad.outcome())) + " " + bad.field();
  }
}

TEST(ParticlesPayload, ReadsNav2ParticleClouds) {
  EXPECT_EQ(decoded(kCloud), (Weights{0.25, 0.75}));
  EXPECT_EQ(decoded(as_cbor(kCloud)), (Weights{0.25, 0.75}));
}

TEST(ParticlesPayload, ReadsPlainWeights) {
  for (const char* text : {R"({"weights":[0.5,1,0]})", " [0.5, 1, 0] "}) {
    EXPECT_EQ(decoded(text), (Weights{0.5, 1.0, 0.0})) << text;
    EXPECT_EQ(decoded(as_cbor(text)), (Weights{0.5, 1.0, 0.0})) << text;
  }
}

TEST(ParticlesPayload, NamesWhatIsWrong) {
  EXPECT_EQ(complaint(""), "malformed payload");
  EXPECT_EQ(complaint("{"), "malformed payload");
  EXPECT_EQ(complaint("[1,2"), "malformed payload");
  EXPECT_EQ(complaint("[1]]"), "malformed payload");
  EXPECT_EQ(complaint("[1],\"weights\":[2]"), "decoded");  // one object after all
  EXPECT_EQ(complaint("[]"), "missing_field particles");
  EXPECT_EQ(complaint("{}"), "missing_field particles");
  EXPECT_EQ(complaint(R"({"particles":7})"), "wrong_type particles");
  EXPECT_EQ(complaint(R"({"particles":[7]})"), "wrong_type particles");
  EXPECT_EQ(complaint(R"({"particles":[{"pose":{}}]})"), "missing_field weight");
  EXPECT_EQ(complaint(R"(["heavy"])"), "wrong_type weights");
  EXPECT_EQ(complaint("[-1]"), "wrong_type weight");
  EXPECT_EQ(complaint("[NaN]"), "wrong_type weight");
  EXPECT_EQ(complaint("[Infinity]"), "wrong_type weight");
  EXPECT_EQ(complaint(as_cbor("7")), "malformed payload");
  EXPECT_EQ(complaint(as_cbor(R"({"particles":[{"weight":"heavy"}]})")), "wrong_type weight");
  EXPECT_EQ(complaint(as_cbor("[1]") + "x"), "malformed payload");
  EXPECT_EQ(complaint(std::string(10'001, ' ')), "too_large payload");
}

TEST(ParticlesPayload, StopsAtAHundredThousand) {
  std::string many(1 + kMaxParticles, '\1');  // of a CBOR array of indefinite length
  many.front() = '\x9f';
  ParticlesDecoder decoder(1'000'000);
  EXPECT_EQ(decoder.decode(many + '\xff').size(), kMaxParticles);
  EXPECT_THROW((void)decoder.decode(many + "\1\xff"), core::BadScan);
}

RC_GTEST_PROP(ParticlesPayload, SurvivesAnything, (const std::string& payload)) {
  RC_ASSERT(complaint(payload).find(' ') != std::string::npos || complaint(payload) == "decoded");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
