// SPDX-License-Identifier: Apache-2.0
// Secrets made, hashed and compared by OpenSSL.
#include "api/auth.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include "adapters/codecs/rfc3339.hpp"
#include "core/names.hpp"
#include "core/robot.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::Json;
using core::BadInput;

constexpr std::array<std::string_view, 3> kRoles{"viewer", "operator", "admin"};
constexpr std::string_view kPrefix = "kw_";  // so that scanners find a secret that leaked
constexpr std::size_t kSecretBytes = 32;
constexpr std::size_t kIdBytes = 6;
constexpr std::size_t kLongestName = 64;

std::string hex(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::string random_hex(std::size_t bytes) {
  std::vector<unsigned char> random(bytes);
  if (RAND_bytes(random.data(), static_cast<int>(bytes)) != 1) {
    throw std::runtime_error("no random numbers are to be had");
  }
  return hex(random);
}

std::string sha256_of(std::string_view secret) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(secret.data()), secret.size(), digest.data());
  return hex(digest);
}

bool is_hash(std::string_view text) {
  return text.size() == std::size_t{2} * SHA256_DIGEST_LENGTH &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void check(const Caller& caller) {
  const bool printable =
      std::ranges::all_of(caller.name, [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
  if (caller.name.empty() || caller.name.size() > kLongestName || !printable) {
    throw BadInput("name", "must be 1 to 64 printable characters");
  }
  for (const auto& robot : caller.robots) {
    if (!core::is_robot_id(robot)) {
      throw BadInput("robot", "'" + robot + "' is no robot id");
    }
  }
}

std::string text_of(const Json& object, const std::string& member) {
  const auto found = object.find(member);
  if (found == object.end() || !found->is_string()) {
    throw BadInput(member, "must be a string");
  }
  return found->get<std::string>();
}

Token token_of(const Json& object) {
  if (!object.is_object()) {
    throw BadInput("tokens", "must be objects");
  }
  Token token{
      .id = text_of(object, "id"),
      .caller = {.name = text_of(object, "name"),
                 .role = role(text_of(object, "role")),
                 .robots = {}},
      .created = adapters::codecs::stamp_from_rfc3339(text_of(object, "created"), "created"),
      .sha256 = text_of(object, "sha256")};
  const Json robots = object.value("robots", Json::array());
  if (!robots.is_array()) {
    throw BadInput("robots", "must be a list");
  }
  for (const auto& robot : robots) {
    token.caller.robots.push_back(robot.is_string() ? robot.get<std::string>() : "");
  }
  if (!is_hash(token.sha256)) {
    throw BadInput("sha256", "must be 64 hex digits");
  }
  check(token.caller);
  return token;
}

}  // namespace

std::string_view name(Role role) { return kRoles.at(static_cast<std::size_t>(role)); }

Role role(std::string_view text) { return core::named<Role>(kRoles, text, "role"); }

bool Caller::may_see(std::string_view robot) const {
  return robots.empty() || std::ranges::find(robots, robot) != robots.end();
}

NewToken new_token(Caller caller, core::Stamp now) {
  check(caller);
  const std::string secret = std::string(kPrefix) + random_hex(kSecretBytes);
  return {{random_hex(kIdBytes), std::move(caller), now, sha256_of(secret)}, secret};
}

std::optional<Caller> caller_of(std::span<const Token> tokens, std::string_view secret) {
  const std::string hash = sha256_of(secret);
  const Token* found = nullptr;
  for (const Token& token : tokens) {  // all of them: the time must not tell which
    if (token.sha256.size() == hash.size() &&
        CRYPTO_memcmp(token.sha256.data(), hash.data(), hash.size()) == 0) {
      found = &token;
    }
  }
  return found != nullptr ? std::optional(found->caller) : std::nullopt;
}

Json json(std::span<const Token> tokens) {
  Json list = Json::array();
  for (const Token& token : tokens) {
    list.push_back({{"id", token.id},
                    {"name", token.caller.name},
                    {"role", name(token.caller.role)},
                    {"robots", token.caller.robots},
                    {"created", adapters::codecs::rfc3339(token.created)},
                    {"sha256", token.sha256}});
  }
  return {{"tokens", list}};
}

std::vector<Token> tokens(const Json& json) {
  if (!json.is_object() || !json.contains("tokens") || !json["tokens"].is_array()) {
    throw BadInput("tokens", "must be a list");
  }
  std::vector<Token> all;
  for (const auto& one : json["tokens"]) {
    all.push_back(token_of(one));
  }
  return all;
}

}  // namespace kidnapwatch::api
