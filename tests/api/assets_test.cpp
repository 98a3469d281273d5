// SPDX-License-Identifier: Apache-2.0
// The dashboard as it is served, whether it was built or not.
#include "api/assets.hpp"

#include <set>

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

using AssetsTest = ApiTest;

std::string path_of(const Asset& asset) { return "/assets/" + std::string(asset.name); }

/// The length of what a gzip file unpacks to: its last four bytes (RFC 1952, ISIZE).
std::size_t unpacked_size(std::string_view gzip) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    size = size * 256 + static_cast<unsigned char>(gzip[gzip.size() - 1 - i]);
  }
  return size;
}

TEST_F(AssetsTest, ServesThePageToAnybody) {
  guard = std::make_unique<Guard>([](std::string_view) { return std::nullopt; }, RateLimitConfig{},
                                  [] { return 0.0; });
  EXPECT_EQ(get("/api/v1/me").status, 401);
  const auto page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, assets().front().plain);
  EXPECT_EQ(page.content_type, assets().front().content_type);
  EXPECT_NE(page.body.find("kidnapwatch"), std::string::npos);
}

TEST_F(AssetsTest, AreCompressedForWhoTakesIt) {
  for (const auto& asset : assets()) {
    const auto packed = get(path_of(asset), {{"Accept-Encoding", "deflate, gzip, br"}});
    EXPECT_EQ(header_of(packed, "Content-Encoding"), "gzip");
    EXPECT_EQ(packed.body.substr(0, 2), "\x1f\x8b") << asset.name;
    EXPECT_EQ(unpacked_size(packed.body), asset.plain.size());
    for (const char* none : {"", "br", "gzip;q=0"}) {
      const auto plain = get(path_of(asset), {{"Accept-Encoding", none}});
      EXPECT_EQ(header_of(plain, "Content-Encoding"), "") << none;
      EXPECT_EQ(plain.body, asset.plain);
      EXPECT_EQ(header_of(plain, "Vary"), "Accept-Encoding");
    }
  }
}

TEST_F(AssetsTest, AreNotSentAgain) {
  std::set<std::string> tags;
  for (const auto& asset : assets()) {
    for (const char* coding : {"gzip", "identity"}) {
      const auto tag = header_of(get(path_of(asset), {{"Accept-Encoding", coding}}), "ETag");
      EXPECT_TRUE(tags.insert(tag).second) << tag;
      const auto again = get(path_of(asset), {{"Accept-Encoding", coding}, {"If-None-Match", tag}});
      EXPECT_EQ(again.status, 304);
      EXPECT_EQ(again.content_type + again.body, "");
      EXPECT_EQ(header_of(again, "ETag"), tag);
      EXPECT_EQ(get(path_of(asset), {{"If-None-Match", "\"other\""}}).status, 200);
    }
  }
}

TEST_F(AssetsTest, RunOnlyWhatIsBuiltIn) {
  for (const auto& asset : assets()) {
    const auto response = get(path_of(asset));
    const auto policy = header_of(response, "Content-Security-Policy");
    EXPECT_TRUE(policy.starts_with("default-src 'self';")) << policy;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos);
    EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string::npos);
    EXPECT_EQ(header_of(response, "Referrer-Policy"), "no-referrer");
  }
  const auto page = assets().front().plain;
  for (const char* inlined : {"<style", "style=", "onclick", "http:", "https:"}) {
    EXPECT_EQ(page.find(inlined), std::string_view::npos) << inlined;
  }
}

TEST_F(AssetsTest, LoadInAMomentOnAPhone) {
  std::size_t bytes = 0;
  for (const auto& asset : assets()) {
    bytes += asset.gzip.size();
  }
  EXPECT_LT(bytes, 150'000U);
}

TEST_F(AssetsTest, AreNothingElse) {
  for (const char* target : {"/assets/x.js", "/assets/..%2Findex.html", "/index.html"}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
}

}  // namespace
}  // namespace kidnapwatch::api
