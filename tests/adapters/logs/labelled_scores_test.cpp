// SPDX-License-Identifier: Apache-2.0
// Labelled scores: what is read, what is skipped, what is refused.
#include "adapters/logs/labelled_scores.hpp"

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using LabelledScoresTest = LogFileTest;

TEST_F(LabelledScoresTest, AreTheColumnsBehindTheLabel) {
  const auto file = gzipped("run.csv.gz",
                            "%time,field.label,field.scan_score,other\r\n"
                            "1.6E+018,0,1.5,-2\r\n"
                            "1.6E+018,1,2.5e1,3\r\n");
  const LabelledScores read = read_labelled_scores(file);
  EXPECT_EQ(read.names, (std::vector<std::string>{"scan_score", "other"}));
  ASSERT_EQ(read.rows.size(), 2U);
  EXPECT_FALSE(read.rows[0].lost);
  EXPECT_TRUE(read.rows[1].lost);
  EXPECT_EQ(read.rows[1].scores, (std::vector{25.0, 3.0}));
  EXPECT_EQ(read.skipped_lines, 0U);
}

TEST_F(LabelledScoresTest, SkipsRowsThatAreNotAllNumbers) {
  const auto file = plain("run.csv", "field.label,a\n0,1\n0,nan\n0,inf\n0\n0,1,2\n0,\nx,1\n1,2\n");
  const LabelledScores read = read_labelled_scores(file);
  EXPECT_EQ(read.rows.size(), 2U);
  EXPECT_EQ(read.skipped_lines, 6U);
}

TEST_F(LabelledScoresTest, RefusesOtherFiles) {
  const auto reason = [&](std::string_view text) {
    return refusal([&] { static_cast<void>(read_labelled_scores(plain("run.csv", text))); });
  };
  EXPECT_NE(reason("").find("empty"), std::string::npos);
  EXPECT_NE(reason("a,b\n1,2\n").find("no column field.label"), std::string::npos);
  EXPECT_NE(reason("field.label,a\nx,y\n").find("no row"), std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
