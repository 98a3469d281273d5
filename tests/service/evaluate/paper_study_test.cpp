// SPDX-License-Identifier: Apache-2.0
// The paper's experiments at toy size: the same numbers on any number of threads, and all files.
#include "service/evaluate/paper_study.hpp"

#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "core/bad_input.hpp"
#include "service/evaluate/paper_report.hpp"
#include "service/evaluate/parallel.hpp"

namespace kidnapwatch::service {
namespace {

TEST(InParallel, DoesEveryPieceOnce) {
  for (const std::size_t threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> done(100);
    in_parallel(done.size(), threads, "pieces", [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
  in_parallel(0, 2, "nothing", [](std::size_t) { FAIL(); });
}

TEST(InParallel, ThrowsWhatAPieceThrew) {
  const auto work = [](std::size_t i) {
    if (i == 3) throw std::runtime_error("third");
  };
  EXPECT_THROW(in_parallel(10, 3, "pieces", work), std::runtime_error);
}

class PaperTest : public ::testing::Test {
 public:
  ~PaperTest() override { std::filesystem::remove_all(options_.data); }

 protected:
  PaperTest() {
    std::string path = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
    EXPECT_NE(mkdtemp(path.data()), nullptr);
    options_.out = std::filesystem::path(path) / "report";
    options_.data = path;  // without recorded runs
    options_.trials = 2;
    options_.steps = 5;
    options_.particles = 50;
    options_.figures = {2, 3, 6, 7, 8, 9};
  }

  [[nodiscard]] std::string written(const std::string& name) const {
    std::ifstream file(options_.out / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  PaperOptions options_;
};

TEST_F(PaperTest, GivesTheSameNumbersOnOneThreadAndOnSeveral) {
  options_.threads = 1;
  write_report(run_paper(options_), options_, "test", "now");
  const std::string alone = written("summary.csv") + written("eta.csv");
  options_.threads = 3;
  write_report(run_paper(options_), options_, "test", "now");
  EXPECT_EQ(written("summary.csv") + written("eta.csv"), alone);
  EXPECT_GT(alone.size(), 10'000U);
}

TEST_F(PaperTest, WritesAReportWithEveryFigure) {
  write_report(run_paper(options_), options_, "the command", "the date");
  const std::string html = written("report.html");
  for (const int figure : {2, 3, 6, 7, 8, 9}) {
    EXPECT_NE(html.find("Figure " + std::to_string(figure) + "."), std::string::npos) << figure;
    EXPECT_NE(written("figure-" + std::to_string(figure) + ".svg").find("</svg>"),
              std::string::npos);
  }
  EXPECT_NE(html.find("the command"), std::string::npos);
  EXPECT_NE(written("paper.json").find("\"claims\""), std::string::npos);
}

TEST_F(PaperTest, StudiesSimulatedRunsWhereNoneAreRecorded) {
  options_.figures = {13, 15};
  options_.steps = 15;
  options_.kidnappings = 8;
  const PaperResults results = run_paper(options_);
  EXPECT_TRUE(results.conditions.empty());
  ASSERT_TRUE(results.roc);
  EXPECT_EQ(results.roc->runs, 10U);
  EXPECT_EQ(results.roc->single.size(), 12U);
  EXPECT_EQ(results.roc->single[0].roc.kidnapped, 80U);
  EXPECT_EQ(results.roc->single[0].roc.natural, 290U);
  EXPECT_GT(results.roc->regression->roc.auc, 0.5);
  EXPECT_FALSE(results.milvus);
  write_report(results, options_, "test", "now");
  EXPECT_NE(written("figure-15.svg").find("logistic regression"), std::string::npos);
}

TEST_F(PaperTest, StudiesLabelledRuns) {
  options_.figures = {13};
  options_.steps = 3;
  const auto folder = options_.data / "milvus_loss_labels";
  std::filesystem::create_directories(folder);
  for (const char* run : {"a", "b", "c"}) {
    std::string table = "field.label,field.score,field.noise,field.map_update_count\n";
    for (int i = 0; i < 60; ++i) {
      const bool lost = i % 5 == 0;
      table += std::string(lost ? "1," : "0,") + std::to_string((lost ? -3 : 0) + i % 4) + "," +
               std::to_string(i * 7 % 11) + "," + std::to_string(i) + "\n";
    }
    gzFile file = gzopen((folder / (std::string(run) + "_labeled.csv.gz")).c_str(), "wb");
    gzputs(file, table.c_str());
    gzclose(file);
  }
  const PaperResults results = run_paper(options_);
  ASSERT_TRUE(results.milvus);
  EXPECT_EQ(results.milvus->runs, 3U);
  ASSERT_EQ(results.milvus->single.size(), 2U);  // the counter is no score
  EXPECT_EQ(results.milvus->single[0].id, "score (falls)");
  EXPECT_GT(results.milvus->regression->median_auc, 0.8);
}

TEST_F(PaperTest, RunsWhatTheFigureNeeds) {
  options_.figures = {2};
  const PaperResults results = run_paper(options_);
  ASSERT_EQ(results.conditions.size(), 12U);  // 3 maps, 3 noises and a longer reach
  EXPECT_EQ(results.conditions[0].prior.size(), 32U);
  EXPECT_FALSE(results.roc);
}

TEST_F(PaperTest, RefusesAFolderThatItCannotMake) {
  options_.figures = {2};
  options_.out = "/dev/null/report";
  EXPECT_THROW(write_report({}, options_, "", ""), core::BadInput);
}

}  // namespace
}  // namespace kidnapwatch::service
