#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/errors.h"
#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/needle_cell.h"
#include "cell/mesh/section_mesher.h"

namespace microinjection {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <typename Config>
std::string errorsOf(const Config& config) {
  try {
    config.validate();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

void expectAll(const std::string& errors, const std::vector<std::string>& expected) {
  for (const std::string& text : expected) EXPECT_NE(errors.find(text), std::string::npos) << text << " in\n" << errors;
}

TEST(CellMeshConfig, NamesAllErrorsAtOnce) {
  CellMeshConfig config = needleCell();
  EXPECT_EQ(errorsOf(config), "");
  config.size = -1;
  config.growth = 1.5;
  config.stretch = 0.5;
  config.refinements[0].size = 0;
  config.refinements[0].side = 0.5;
  config.refinements.push_back({CellMeshConfig::Shape::kCircle, {20e-6, 0}, 9e-6, +1, 1e-6});
  config.refinements.push_back({CellMeshConfig::Shape::kBall, {29e-6, 0}, -1e-6, +1, 1e-6});
  config.imprints[0].centre = {25e-6, 0};  // the disc would hang over the edge
  config.imprints.push_back({{0, 5e-6}, 10e-6, -1});
  expectAll(errorsOf(config),
            {"size = -1", "growth = 1.5", "stretch = 0.5", "refinements[0].size = 0", "refinements[0].side = 0.5",
             "refinements[1].radius = 9e-06", "refinements[2].centre = 2.9e-05", "refinements[2].radius = -1e-06",
             "imprints[0].radius = 3e-06", "imprints[2].radius = 1e-05: must be such that it keeps 0.05"});
  EXPECT_THROW(makeCellMesh(config), ConfigError);
}

TEST(CellMeshConfig, RefusesLayersThatAreNone) {
  const auto with = [](const std::vector<double>& radii) {
    CellMeshConfig config;
    config.radii = radii;
    return errorsOf(config);
  };
  expectAll(with({}), {"radii is empty"});
  expectAll(with({28e-6, 28e-6}), {"radii[0] = 2.8e-05: must be descending"});
  expectAll(with({28e-6, 30e-6, -1e-6}), {"radii[0]", "radii[2] = -1e-06"});
  expectAll(with({28e-6, 0.1e-6}), {"radii[1] = 1e-07"});
  expectAll(with({kNan}), {"radii[0] = nan"});
  EXPECT_EQ(with({28e-6, 27.5e-6, 1e-6}), "");
}

TEST(CellMeshConfig, RefusesWhatIsNotANumber) {
  const auto with = [](const std::function<void(CellMeshConfig&)>& change) {
    CellMeshConfig config = needleCell();
    change(config);
    return errorsOf(config);
  };
  EXPECT_NE(with([](auto& c) { c.size = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.growth = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.refinements[0].centre.x() = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.refinements[0].radius = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.refinements[0].size = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.imprints[0].centre.y() = kNan; }), "");
  EXPECT_NE(with([](auto& c) { c.imprints[0].radius = kNan; }), "");
}

TEST(CellMeshConfig, CirclesOfTheTwoSidesAndInOneAnotherAreFine) {
  CellMeshConfig config = needleCell();
  config.imprints = {{{0, 0}, 10e-6, +1}, {{0, 0}, 10e-6, -1}, {{2e-6, 0}, 3e-6, +1}, {{18e-6, 0}, 3e-6, +1}};
  EXPECT_EQ(errorsOf(config), "");
}

TEST(SectionMeshConfig, NamesAllErrorsAtOnce) {
  SectionMeshConfig config;
  EXPECT_EQ(errorsOf(config), "");
  config.size = 0;
  config.growth = -0.1;
  config.refinements = {{29e-6, 1, 0, 1e-6}, {3e-6, 0, -1e-6, kNan}};
  config.vertices = {{-1e-6, 1}, {1e-6, 2}};
  expectAll(errorsOf(config), {"size = 0", "growth = -0.1", "refinements[0].r = 2.9e-05", "refinements[1].side = 0",
                               "refinements[1].reach = -1e-06", "refinements[1].size = nan", "vertices[0].r = -1e-06",
                               "vertices[1].side = 2"});
  EXPECT_THROW(makeSectionMesh(config), ConfigError);
  config = {};
  config.radii = {28e-6, 28e-6};
  expectAll(errorsOf(config), {"radii[0] = 2.8e-05"});
}

TEST(SectionMeshConfig, PointsAreTheSameOrApart) {
  SectionMeshConfig config;
  config.vertices = {{3e-6, 1}, {3e-6, 1}, {0, -1}, {28e-6, 1}, {28e-6, -1}};
  EXPECT_EQ(errorsOf(config), "");
  config.vertices.push_back({3e-6 * (1 + 1e-6), 1});
  expectAll(errorsOf(config), {"distance of neighbouring points"});
  config.vertices.back() = {1e-12, 1};
  expectAll(errorsOf(config), {"distance of neighbouring points"});
}

}  // namespace
}  // namespace microinjection
