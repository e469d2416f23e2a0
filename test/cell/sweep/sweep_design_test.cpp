#include "cell/sweep/sweep_design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/errors.h"
#include "cell/sweep/scene_variation.h"

namespace microinjection {
namespace {

SweepDesign design(const std::string& yaml) {
  ConfigReader reader(YAML::Load(yaml), "sweep");
  const SweepDesign read = SweepDesign::read(reader);
  reader.finish();
  return read;
}

std::string error(const std::string& yaml) {
  try {
    design(yaml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

using Texts = std::vector<std::string>;

TEST(SweepDesign, AGridHasEachCombinationOnce) {
  const SweepDesign grid = design(
      "{keys: [{key: a, values: [x, 2e-6]}, {key: b, from: 1, to: 100, count: 3, scale: log},"
      " {key: c, from: 0, to: 1, count: 2}]}");
  ASSERT_EQ(grid.size(), 12u);
  EXPECT_EQ(grid.values(0), (Texts{"x", "1", "0"}));
  EXPECT_EQ(grid.values(1), (Texts{"x", "1", "1"}));
  EXPECT_EQ(grid.values(2), (Texts{"x", "10", "0"}));
  EXPECT_EQ(grid.values(11), (Texts{"2e-6", "100", "1"}));
  std::set<Texts> all;
  for (std::size_t i = 0; i < grid.size(); ++i) all.insert(grid.values(i));
  EXPECT_EQ(all.size(), grid.size());
}

TEST(SweepDesign, ARandomDesignIsEvenInItsRange) {
  const SweepDesign random = design(
      "{design: random, samples: 4000, seed: 3, keys: [{key: a, from: 1, to: 100, scale: log},"
      " {key: b, values: [p, q]}, {key: c, from: -1, to: 3}]}");
  ASSERT_EQ(random.size(), 4000u);
  double logarithms = 0, sum = 0, product = 0, first = 0;
  int p = 0;
  for (std::size_t i = 0; i < random.size(); ++i) {
    const Texts values = random.values(i);
    const double a = std::log10(std::stod(values[0])), c = std::stod(values[2]);
    EXPECT_TRUE(a >= 0 && a <= 2 && c >= -1 && c <= 3);
    logarithms += a;
    sum += c;
    product += (a - 1) * (c - 1);
    first += (a - 1) * (a - 1);
    p += values[1] == "p";
  }
  // Each bound is five standard errors of the mean.
  EXPECT_NEAR(logarithms / 4000, 1, 5 * 0.58 / std::sqrt(4000));
  EXPECT_NEAR(first / 4000, 1 / 3., 5 * 0.3 / std::sqrt(4000));
  EXPECT_NEAR(sum / 4000, 1, 5 * 1.16 / std::sqrt(4000));
  EXPECT_NEAR(product / 4000, 0, 5 * 0.67 / std::sqrt(4000));
  EXPECT_NEAR(p, 2000, 5 * 31.7);
  EXPECT_EQ(random.values(7), random.values(7));
  EXPECT_NE(random.values(7), design("{design: random, samples: 9, seed: 4, keys: [{key: a, from: 1, to: 100, scale: "
                                     "log}, {key: b, values: [p, q]}, {key: c, from: -1, to: 3}]}")
                                  .values(7));
}

TEST(SweepDesign, ErrorsNameTheKey) {
  EXPECT_NE(error("{keys: []}").find("keys = []: must name at least one key"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, from: 0, to: 1, count: 3, scale: log}]}").find("keys/0/scale = log: needs from"),
            std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, from: 0, to: 1}]}").find("keys/0/count is missing"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, values: []}]}").find("keys/0/values = []: must be a list"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, values: [1, [2, 3]]}]}").find("scalars, not of lists or maps"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, values: [{b: 1}]}]}").find("scalars, not of lists or maps"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, values: [1]}, {key: a, values: [2]}]}").find("keys/1/key = a: is there twice"),
            std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, values: [1], step: 2}]}").find("keys/0/step: unknown key"), std::string::npos);
  EXPECT_NE(error("{design: random, keys: [{key: a, values: [1]}]}").find("samples is missing"), std::string::npos);
  EXPECT_NE(error("{keys: [{key: a, from: 0, to: 1, count: 10000}, {key: b, from: 0, to: 1, count: 10000}]}")
                .find("must be fewer"),
            std::string::npos);
}

TEST(SceneVariation, SetsValuesAndLeavesTheRest) {
  const YAML::Node scene = YAML::Load("{cell: {layers: [{e: 1}, {e: 2}], d: 3}, x: [0, 0]}");
  const YAML::Node changed = varied(scene, {"cell/layers/1/e", "x/0", "mesh/size"}, {"7", "5e-6", "1e-6"});
  EXPECT_EQ(changed["cell"]["layers"][0]["e"].as<double>(), 1);
  EXPECT_EQ(changed["cell"]["layers"][1]["e"].as<double>(), 7);
  EXPECT_EQ(changed["x"][0].as<double>(), 5e-6);
  EXPECT_EQ(changed["mesh"]["size"].as<double>(), 1e-6);
  EXPECT_EQ(scene["cell"]["layers"][1]["e"].as<double>(), 2) << "the original stays";
  EXPECT_FALSE(scene["mesh"].IsDefined());
  EXPECT_THROW(varied(scene, {"cell/layers/2/e"}, {"1"}), ConfigError);
  EXPECT_THROW(varied(scene, {"cell/d/e"}, {"1"}), ConfigError);
  EXPECT_THROW(varied(scene, {"cell/layers"}, {"1"}), ConfigError);
}

TEST(SceneVariation, AnAliasKeepsItsValue) {
  const YAML::Node scene = YAML::Load("{a: &a {e: 1, l: [2, 3]}, b: *a, c: &c 4, d: *c}");
  const YAML::Node changed = varied(scene, {"a/e", "b/l/0", "c"}, {"7", "8", "9"});
  YAML::Emitter out;
  out << YAML::Flow << changed;
  EXPECT_STREQ(out.c_str(), "{a: {e: 7, l: [2, 3]}, b: {e: 1, l: [8, 3]}, c: 9, d: 4}");
  EXPECT_THROW(varied(YAML::Load("{a: &a [1, *a]}"), {"b"}, {"1"}), ConfigError) << "it is in itself";
}

}  // namespace
}  // namespace microinjection
