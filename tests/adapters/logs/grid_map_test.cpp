// SPDX-License-Identifier: Apache-2.0
// Maps of both formats lie the right way round; broken ones are refused.
#include "adapters/logs/grid_map.hpp"

#include <string>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using core::baselines::Cell;
using core::baselines::GridMap;

class GridMapTest : public LogFileTest {
 protected:
  [[nodiscard]] std::string refused_map(const std::string& text,
                                        const std::string& name = "map.yaml") const {
    return refusal([&] { static_cast<void>(read_grid_map(plain(name, text))); });
  }

  void draw(const std::string& image) const { static_cast<void>(plain("floor.pgm", image)); }
};

Cell at(const GridMap& map, double x_m, double y_m) {
  return map.at(map.layout.column_at(x_m), map.layout.row_at(y_m));
}

const std::string kYaml =
    "image: floor.pgm\nmode: trinary\nresolution: 0.5\norigin: [-1.0, 2.0, 0]\n"
    "negate: 0  # black is a wall\noccupied_thresh: 0.65\nfree_thresh: 0.25\n";
const std::string kPixels = {'\0', '\xfe', '\xfe', '\xcd', '\xfe', '\n'};  // two rows of three
const std::string kPgm = "P5\n# CREATOR: map_saver 0.500 m/pix\n3 2\n255\n" + kPixels;

TEST_F(GridMapTest, ReadsTheMapServersNorthUp) {
  draw(kPgm);
  const GridMap map = read_grid_map(plain("map.yaml", kYaml));
  EXPECT_EQ(map.layout, (core::baselines::GridLayout{-1.0, 2.0, 0.5, 3, 2}));
  EXPECT_EQ(at(map, -0.75, 2.75), Cell::occupied);  // north-west
  EXPECT_EQ(at(map, 0.25, 2.75), Cell::free);
  EXPECT_EQ(at(map, -0.75, 2.25), Cell::unknown);
  EXPECT_EQ(at(map, -0.25, 2.25), Cell::free);
  EXPECT_EQ(at(map, 0.25, 2.25), Cell::occupied);  // '\n' is nearly black
}

TEST_F(GridMapTest, ReadsAnImageThatIsGzipped) {
  ASSERT_TRUE(exists(gzipped("floor.pgm.gz", kPgm)));
  EXPECT_EQ(read_grid_map(gzipped("map.yaml.gz", kYaml)).cells.size(), 6U);
}

TEST_F(GridMapTest, NegatesWhereTheMapSaysSo) {
  draw(kPgm);
  std::string yaml = kYaml;
  yaml.replace(yaml.find("negate: 0"), 9, "negate: 1");
  EXPECT_EQ(at(read_grid_map(plain("map.yaml", yaml)), -0.75, 2.75), Cell::free);
}

std::string without(const std::string& line) {
  std::string yaml = kYaml;
  const std::size_t begin = yaml.find(line);
  return yaml.erase(begin, yaml.find('\n', begin) + 1 - begin);
}

TEST_F(GridMapTest, RefusesYamlThatIsNoMap) {
  draw(kPgm);
  EXPECT_NE(refused_map(without("resolution")).find("resolution: missing"), std::string::npos);
  EXPECT_NE(refused_map(without("origin")).find("origin: missing"), std::string::npos);
  EXPECT_NE(refused_map(without("origin") + "origin: [0, 0, 0.5]\n").find("turned"),
            std::string::npos);
  EXPECT_NE(refused_map(without("mode") + "mode: raw\n").find("mode"), std::string::npos);
  EXPECT_NE(refused_map(without("resolution") + "resolution: -1\n").find("not above 0"),
            std::string::npos);
  EXPECT_NE(refused_map(without("image") + "image: elsewhere.pgm\n"), "");
  EXPECT_NE(refused_map("x: 1\n").find("no map of a known format"), std::string::npos);
}

TEST_F(GridMapTest, RefusesImagesThatAreNone) {
  for (const std::string& image :
       {std::string(), std::string("P2\n3 2\n255\n1 2 3"), std::string("P5\n3 2\n65535\nxxxxxx"),
        std::string("P5\n3 2\n255\nxxxxx"), std::string("P5\n-3 2\n255\nxxxxxx"),
        std::string("P5\n# no end"), std::string("P5\n65536 65536\n255\nxxxxxx"),
        std::string("P5\n3")}) {
    draw(image);
    EXPECT_NE(refused_map(kYaml).find("image"), std::string::npos) << image;
  }
}

const std::string kCmu =
    "robot_specifications->global_mapsize_x 30\nrobot_specifications->resolution 10\n\n"
    "global_map[0]: 3 2\n-1.0 0.9\n0.0 0.5\n0.8 0.1 \n";

TEST_F(GridMapTest, ReadsCmuMapsWithXDownTheRows) {
  const GridMap map = read_grid_map(gzipped("wean.dat.gz", kCmu));
  EXPECT_EQ(map.layout, (core::baselines::GridLayout{0.0, 0.0, 0.1, 3, 2}));
  EXPECT_EQ(at(map, 0.05, 0.05), Cell::unknown);
  EXPECT_EQ(at(map, 0.05, 0.15), Cell::free);
  EXPECT_EQ(at(map, 0.15, 0.05), Cell::occupied);
  EXPECT_EQ(at(map, 0.15, 0.15), Cell::unknown);
  EXPECT_EQ(at(map, 0.25, 0.05), Cell::free);
  EXPECT_EQ(at(map, 0.25, 0.15), Cell::occupied);
}

TEST_F(GridMapTest, RefusesCmuMapsThatAreBroken) {
  const auto refused_cmu = [&](const std::string& text) { return refused_map(text, "m.dat"); };
  EXPECT_NE(refused_cmu(kCmu.substr(0, kCmu.size() - 10)).find("cut off"), std::string::npos);
  EXPECT_NE(refused_cmu(kCmu.substr(0, kCmu.size() - 5)).find("missing"), std::string::npos);
  EXPECT_NE(refused_cmu("robot_specifications->resolution 10\n").find("global_map"),
            std::string::npos);
  EXPECT_NE(refused_cmu("robot_specifications->x\nglobal_map[0]: 1 1\n1\n").find("resolution"),
            std::string::npos);
  EXPECT_NE(refused_cmu("robot_specifications->resolution 1\nglobal_map[0]: 65536 65536\n")
                .find("too large"),
            std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
