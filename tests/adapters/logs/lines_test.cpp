// SPDX-License-Identifier: Apache-2.0
// Lines and words, and what stops a hostile file.
#include "adapters/logs/lines.hpp"

#include <cmath>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using LinesTest = LogFileTest;

std::vector<std::string> all(Lines& lines) {
  std::vector<std::string> found;
  while (lines.next()) found.emplace_back(lines.text());
  return found;
}

TEST_F(LinesTest, GivesPlainAndGzippedLinesWithoutTheirEnds) {
  constexpr std::string_view kText = "one\ntwo\r\n\nlast";
  const std::vector<std::string> expected{"one", "two", "", "last"};
  Lines plain_lines(plain("a", kText));
  EXPECT_EQ(all(plain_lines), expected);
  Lines gzipped_lines(gzipped("b", kText));
  EXPECT_EQ(all(gzipped_lines), expected);
}

TEST_F(LinesTest, GivesLinesAcrossBlocksWhole) {
  std::string text;
  for (int i = 0; i < 30'000; ++i) text += std::to_string(i) + "\n";
  Lines lines(gzipped("long", text));
  EXPECT_EQ(lines.head().substr(0, 4), "0\n1\n");
  const auto found = all(lines);
  ASSERT_EQ(found.size(), 30'000U);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], std::to_string(i));
}

TEST_F(LinesTest, KnowsWhereItIs) {
  const auto file = plain("here", "a\nb\n");
  Lines lines(file);
  EXPECT_EQ(lines.where(), file.string());
  ASSERT_TRUE(lines.next());
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.where(), file.string() + ":2");
  EXPECT_FALSE(lines.next());
}

TEST_F(LinesTest, AnEmptyFileHasNoLines) {
  Lines lines(plain("empty", ""));
  EXPECT_EQ(lines.head(), "");
  EXPECT_FALSE(lines.next());
}

TEST_F(LinesTest, CutsLongLines) {
  Lines lines(plain("long", std::string(10 << 20, 'x') + "\nnext\n"));
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.text().size(), std::size_t{1} << 20U);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.text(), "next");
  EXPECT_EQ(lines.where(), (directory_ / "long").string() + ":2");
}

TEST_F(LinesTest, StopsUnpackingAtTheLimit) {
  std::string text;
  for (int i = 0; i < 400'000; ++i) text += "0 0\n";
  const auto file = gzipped("bomb.gz", text);
  ASSERT_LT(std::filesystem::file_size(file), 10'000U);
  Lines lines(file, {.longest_line = 100, .whole_text = 1'000'000});
  const std::string said = refusal([&] { all(lines); });
  EXPECT_NE(said.find("bomb.gz:2"), std::string::npos) << said;  // line 2xx,xxx
  EXPECT_NE(said.find("too long"), std::string::npos) << said;
}

TEST_F(LinesTest, RefusesAFileThatIsCutOff) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += std::to_string(i * 7919) + "\n";
  const auto file = gzipped("cut.gz", text);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  Lines lines(file);
  const std::string said = refusal([&] { all(lines); });
  EXPECT_NE(said.find("cut.gz:"), std::string::npos) << said;
  EXPECT_NE(said.find("cut off"), std::string::npos) << said;
}

TEST_F(LinesTest, RefusesAFileThatIsDamaged) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += std::to_string(i * 7919) + "\n";
  const auto file = gzipped("damaged.gz", text);
  std::fstream damage(file, std::ios::in | std::ios::out | std::ios::binary);
  damage.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
  damage << "these bytes are not what they were";
  damage.close();
  Lines lines(file);
  EXPECT_NE(refusal([&] { all(lines); }).find("damaged.gz"), std::string::npos);
}

TEST_F(LinesTest, RefusesWhatIsNoFile) {
  EXPECT_NE(refusal([&] { Lines lines(directory_ / "absent"); }).find("absent"), std::string::npos);
  EXPECT_NE(refusal([&] {
              Lines lines(directory_);
              all(lines);
            }).find(directory_.string()),
            std::string::npos);
}

TEST(Words, AreTakenInTurn) {
  Words words("  FLASER\t2 0.5 -inf  nan 1e3 ");
  EXPECT_EQ(words.word("message"), "FLASER");
  EXPECT_EQ(words.beam_count("n"), 2U);
  const auto ranges = words.ranges(2);
  EXPECT_EQ(ranges, (std::vector<float>{0.5F, -std::numeric_limits<float>::infinity()}));
  EXPECT_TRUE(std::isnan(words.number("x")));
  EXPECT_DOUBLE_EQ(words.finite("y"), 1000.0);
  EXPECT_NO_THROW(words.expect_end());
  EXPECT_EQ(refusal([&] { static_cast<void>(words.word("z")); }), "z: missing");
}

TEST(Words, AreRefusedByField) {
  EXPECT_EQ(refusal([] { static_cast<void>(Words("12x").number("x")); }), "x: not a number");
  EXPECT_EQ(refusal([] { static_cast<void>(Words("inf").finite("x")); }), "x: not finite");
  EXPECT_NE(refusal([] { static_cast<void>(Words("0").beam_count("n")); }), "");
  EXPECT_NE(refusal([] { static_cast<void>(Words("65537").beam_count("n")); }), "");
  EXPECT_NE(refusal([] { static_cast<void>(Words("-1").beam_count("n")); }), "");
  EXPECT_NE(refusal([] { static_cast<void>(Words("1 2").ranges(3)); }), "");
  EXPECT_NE(refusal([] { Words("1").expect_end(); }), "");
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
