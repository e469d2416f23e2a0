#include "cell/family/family.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/errors.h"
#include "cell/family/family_cell.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

constexpr char kFolder[] = MICROINJECTION_SOURCE_DIR "/config/";

Family family(const std::string& name) { return Family::load(std::string(kFolder) + "families/" + name + ".yaml"); }
Scene cell(const std::string& name) { return loadScene(std::string(kFolder) + "cells/" + name + ".yaml"); }

TEST(Family, AMemberHasTheCoordinatesItWasMadeFrom) {
  for (const char* name : {"homogeneous", "zona"}) {
    const Family cells = family(name);
    for (const Eigen::Vector3d& x :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -1, 1), Eigen::Vector3d(-0.3, 0.7, 0.2)}) {
      const auto found = cells.coordinatesOf(cells.member(x));
      ASSERT_TRUE(found) << name;
      EXPECT_LT((*found - x).norm(), 1e-9) << name;
      EXPECT_TRUE(Family::contains(*found));
    }
  }
}

/// The size and the stiffness of a cell are no coordinates of it.
TEST(Family, ContainsACellOfAnySizeAndStiffness) {
  const Family cells = family("homogeneous");
  Scene scene = cell("mouse_oocyte_pipette");
  const auto before = cells.coordinatesOf(scene);
  ASSERT_TRUE(before);
  scene.cell.material().young_modulus = 15e3;
  scene.cell.layers.front().outer_radius *= 2.5;
  scene.holding_pipette.contact_radius *= 2.5;
  scene.needle.tip.radius *= 2.5;
  const auto after = cells.coordinatesOf(scene);
  ASSERT_TRUE(after);
  EXPECT_LT((*after - *before).norm(), 1e-9);
  EXPECT_NEAR(cells.parameters()[0].value((*after)[0]), 3.0 / 28, 1e-9);
}

TEST(Family, ContainsMeasuredCellsWhoseNumbersAreNotRound) {
  const Family cells = family("homogeneous");
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml");
  for (int i = 1; i < 100; ++i) {
    scene.cell.layers.front().outer_radius = 28e-6 + 1e-8 * M_PI * i;
    scene.cell.material().young_modulus = 15e3 + M_E * i;
    scene.cell.material().poisson_ratio = 0.46 + 1e-4 * M_PI * i;
    EXPECT_TRUE(cells.coordinatesOf(scene)) << i;
  }
}

TEST(Family, AViscoelasticCellIsServedAsItsElasticPart) {
  Scene scene = cell("mouse_oocyte_pipette");
  scene.cell.material().viscoelasticity.prony = {{0.5, 1.0}};
  EXPECT_TRUE(family("homogeneous").coordinatesOf(scene));
}

TEST(Family, OtherCellsAndTipsAreNoMembers) {
  const Family homogeneous = family("homogeneous"), zona = family("zona");
  const Scene scene = cell("mouse_oocyte_pipette");
  EXPECT_FALSE(zona.coordinatesOf(scene));
  EXPECT_FALSE(homogeneous.coordinatesOf(cell("mouse_oocyte_layered")));
  EXPECT_FALSE(homogeneous.coordinatesOf(cell("mouse_oocyte_tensegrity")));
  Scene sticky = cell("mouse_oocyte_pipette");
  ASSERT_TRUE(homogeneous.coordinatesOf(sticky));
  sticky.needle.contact.adhesion_energy = 1e-4;
  sticky.needle.contact.adhesion_range = 0.1e-6;
  std::string misfit;
  EXPECT_FALSE(homogeneous.coordinatesOf(sticky, &misfit));
  EXPECT_NE(misfit.find("adhesion"), std::string::npos) << misfit;
  Scene other = scene;
  other.cell.material().model = "mooney_rivlin";
  EXPECT_FALSE(homogeneous.coordinatesOf(other));
  other = scene;
  other.needle.contact.mode = "sliding";
  EXPECT_FALSE(homogeneous.coordinatesOf(other));
  other = scene;
  other.cell.layers.front().surface_tension = 1e-3;
  EXPECT_FALSE(homogeneous.coordinatesOf(other));
}

TEST(Family, SaysWhyACellIsNoMember) {
  const Family homogeneous = family("homogeneous"), zona = family("zona");
  const auto misfit = [](const Family& cells, const Scene& scene) {
    std::string text = "old";
    const bool is_member = cells.coordinatesOf(scene, &text).has_value();
    EXPECT_EQ(is_member, text.empty()) << text;
    return text;
  };
  const Scene scene = cell("mouse_oocyte_pipette");
  EXPECT_EQ(misfit(homogeneous, scene), "");
  EXPECT_EQ(misfit(zona, scene), "1 layer, not 2");
  EXPECT_EQ(misfit(homogeneous, cell("mouse_oocyte_layered")), "2 layers, not 1");
  EXPECT_EQ(misfit(homogeneous, cell("mouse_oocyte_tensegrity")), "the cell is a tensegrity");
  EXPECT_EQ(misfit(homogeneous, cell("mouse_oocyte_linear")),
            "material linear, not neo_hookean, tip disc, not hemisphere");
  Scene other = scene;
  other.needle.contact.mode = "sliding";
  other.cell.layers.front().surface_tension = 0.1 * 17.9e3 * 28e-6;
  EXPECT_EQ(misfit(homogeneous, other), "surface_tension 0.1, not 0, contact sliding, not sticking");
  other = scene;
  other.cell.layers.front().material.mooney_ratio = 0.5;
  EXPECT_EQ(misfit(homogeneous, other), "mooney_ratio 0.5, not 0.25");
  other = zona.member(Eigen::Vector3d::Zero());
  other.holding_pipette.contact_radius = 0.179;
  EXPECT_EQ(misfit(zona, other), "holding_radius 0.179 of [0.35, 0.364]");
  for (Scene::Layer& layer : other.cell.layers) layer.material.poisson_ratio = 0.3;
  EXPECT_EQ(misfit(zona, other), "holding_radius 0.179 of [0.35, 0.364], poisson_ratio 0.3 of [0.488, 0.492]");
  other.cell.layers[1].material.poisson_ratio = 0.49;
  EXPECT_NE(misfit(zona, other).find("poisson_ratio is not the same in all layers"), std::string::npos);
}

TEST(FindFamilyCell, SaysWhyThereIsNone) {
  const auto reason = [](const std::string& folder, const std::string& name) {
    std::string text;
    EXPECT_FALSE(findFamilyCell(folder, cell(name), text));
    return text;
  };
  EXPECT_EQ(
      reason(std::string(kFolder) + "families", "mouse_oocyte_tensegrity"),
      "no family has cells of this form (family homogeneous: the cell is a tensegrity; family zona: the cell is a "
      "tensegrity)");
  EXPECT_EQ(reason("/nowhere", "mouse_oocyte"), "/nowhere is no folder: must be that of the families");
  const std::string empty = testing::TempDir() + "no_families";
  std::filesystem::create_directories(empty);
  EXPECT_EQ(reason(empty, "mouse_oocyte"), empty + " has no family: must have files *.yaml");
  EXPECT_EQ(reason("", "mouse_oocyte"), "") << "none is asked for";
}

/// A ratio of all layers must be that of each; one that does not vary must be within its borders.
TEST(Family, AConstantRatioHasBorders) {
  const Family zona = family("zona");
  Scene scene = zona.member(Eigen::Vector3d(0.1, 0.2, 0.3));
  scene.holding_pipette.contact_radius = 0.352;
  const auto near = zona.coordinatesOf(scene);
  ASSERT_TRUE(near);
  EXPECT_LT((*near - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-9);
  scene.holding_pipette.contact_radius = 0.34;
  EXPECT_FALSE(zona.coordinatesOf(scene));
}

TEST(Family, OneLayersOwnPoissonRatioIsNotThatOfAll) {
  const Family zona = family("zona");
  Scene scene = zona.member(Eigen::Vector3d::Zero());
  scene.cell.layers[1].material.poisson_ratio = 0.491;
  EXPECT_FALSE(zona.coordinatesOf(scene));
}

TEST(Family, BordersAreInsideAndWhatIsPastThemIsNot) {
  const Family cells = family("homogeneous");
  Scene scene = cells.member(Eigen::Vector3d::Zero());
  for (const double tip : {0.04, 0.2}) {
    scene.needle.tip.radius = tip;
    EXPECT_TRUE(Family::contains(*cells.coordinatesOf(scene))) << tip;
  }
  for (const double tip : {0.0399, 0.2001}) {
    scene.needle.tip.radius = tip;
    EXPECT_FALSE(Family::contains(*cells.coordinatesOf(scene))) << tip;
  }
}

TEST(Family, AThinnerTipHasASmallerRange) {
  const Family cells = family("homogeneous");
  const SurrogateRange thin = cells.range(cells.member(Eigen::Vector3d(-1, 0, 0)));
  const SurrogateRange thick = cells.range(cells.member(Eigen::Vector3d(1, 0, 0)));
  EXPECT_LT(thin.depth, 0.4 * thick.depth);
  EXPECT_NEAR(thin.lateral / thin.depth, thick.lateral / thick.depth, 1e-12);
}

TEST(Family, ABadFileNamesItsKeys) {
  const std::string path = testing::TempDir() + "family.yaml";
  const auto errorOf = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      Family::load(path);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string head = "name: x\nrange: {angle: 1, deepest: 0.7, half_depth_tip: 0.05}\n";
  const std::string scene =
      "scene:\n  cell: {diameter: 2, material: {model: neo_hookean, young_modulus: 1, poisson_ratio: 0.49}}\n"
      "  holding_pipette: {contact_radius: 0.35}\n  needle: {tip: {shape: hemisphere, radius: 0.1}}\n";
  const std::string parameters = "parameters: {tip_radius: [0.04, 0.2]}\n";
  EXPECT_EQ(errorOf(head + scene + parameters), "");
  EXPECT_NE(errorOf(head + parameters).find("scene: is missing"), std::string::npos);
  EXPECT_NE(errorOf(head + scene).find("parameters"), std::string::npos);
  EXPECT_NE(errorOf(head + scene + "parameters: {tip: [1, 2]}\n").find("parameters/tip"), std::string::npos);
  EXPECT_NE(errorOf(head + scene + "parameters: {tip_radius: [0.2, 0.04]}\n").find("parameters/tip_radius"),
            std::string::npos);
  EXPECT_NE(errorOf(head + scene + "parameters: {shell_thickness: [0.1, 0.2]}\n").find("one layer"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
