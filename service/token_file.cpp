// SPDX-License-Identifier: Apache-2.0
// Reading, and replacing as a whole: a crash leaves the old file or the new one.
#include "service/token_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::service {
namespace {

namespace fs = std::filesystem;
namespace codecs = adapters::codecs;

[[noreturn]] void fail(const fs::path& file) {
  throw std::system_error(errno, std::generic_category(), file.string());
}

/// A file descriptor with an owner.
class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags)
      : number_(::open(file.c_str(), flags | O_CLOEXEC, 0600)) {  // for its owner alone
    if (number_ < 0) fail(file);
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// One process at a time changes the file, while this lives.
class Turn {
 public:
  explicit Turn(const fs::path& file) : lock_(fs::path(file) += ".lock", O_RDWR | O_CREAT) {
    if (::flock(lock_.number(), LOCK_EX) != 0) fail(file);
  }

 private:
  Descriptor lock_;
};

void write_durably(const fs::path& file, const std::string& text) {
  const Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC);
  for (std::string_view rest = text; !rest.empty();) {
    const auto written = ::write(out.number(), rest.data(), rest.size());
    if (written < 0) fail(file);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(out.number()) != 0) fail(file);
}

}  // namespace

std::vector<api::Token> TokenFile::tokens() const {
  if (!fs::exists(file_)) return {};
  std::ifstream in(file_, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw core::BadInput(file_.string(), "cannot be read");
  try {
    return api::tokens(codecs::parsed(text.str(), "tokens"));
  } catch (const core::BadInput& error) {
    throw core::BadInput(file_.string() + ": " + error.field(), error.reason());
  }
}

void TokenFile::add(const api::Token& token) {
  fs::create_directories(fs::absolute(file_).parent_path());
  const Turn turn(file_);
  auto all = tokens();
  all.push_back(token);
  replace(all);
}

bool TokenFile::revoke(std::string_view id) {
  if (!fs::exists(file_)) return false;
  const Turn turn(file_);
  auto all = tokens();
  const bool found = std::erase_if(all, [&](const api::Token& one) { return one.id == id; }) > 0;
  if (found) replace(all);
  return found;
}

void TokenFile::replace(const std::vector<api::Token>& tokens) {
  const fs::path unfinished = fs::path(file_) += ".part";
  write_durably(unfinished, codecs::text(api::json(tokens)) + "\n");
  fs::rename(unfinished, file_);
  const Descriptor folder(fs::absolute(file_).parent_path(), O_RDONLY | O_DIRECTORY);
  if (::fsync(folder.number()) != 0) fail(file_);
}

std::optional<api::Caller> TokenFile::caller(std::string_view secret) const {
  return api::caller_of(tokens(), secret);
}

}  // namespace kidnapwatch::service
