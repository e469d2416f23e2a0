#include "cell/model/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "cell/model/scene_texts.h"

namespace microinjection {
namespace {

const std::string kCells = MICROINJECTION_SOURCE_DIR "/config/cells/";

TEST(Scene, ReadsTheMouseOocytes) {
  for (const auto& [file, model] :
       {std::pair("mouse_oocyte.yaml", "neo_hookean"), std::pair("mouse_oocyte_linear.yaml", "linear"),
        std::pair("mouse_oocyte_st_venant_kirchhoff.yaml", "st_venant_kirchhoff")}) {
    const Scene scene = loadScene(kCells + file);
    EXPECT_EQ(scene.cell.material().model, model);
    EXPECT_EQ(scene.cell.diameter(), 56e-6);  // Table I
    EXPECT_EQ(scene.cell.material().young_modulus, 17.9e3);
    EXPECT_EQ(scene.cell.material().poisson_ratio, 0.49);
    EXPECT_EQ(scene.cell.layers.size(), 1u);
    EXPECT_EQ(scene.cell.puncture.layers.at(0).force, 7.5e-6);
    EXPECT_EQ(scene.needle.tip.shape, "disc");
    EXPECT_EQ(scene.holding_pipette.contact_radius, 10e-6);
    EXPECT_EQ(scene.needle.tip.radius, 3e-6);
    EXPECT_EQ(scene.needle.offset, Eigen::Vector2d(0, 0));
  }
}

TEST(Scene, EverySceneThatComesAlongIsValid) {
  int scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(kCells)) {
    EXPECT_NO_THROW(loadScene(file.path())) << file.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 8);
}

TEST(Scene, ReadsAMouth) {
  YAML::Node node = YAML::Load(kLayered);
  node["holding_pipette"] = YAML::Load(
      "{mouth: {inner_radius: 8e-6, outer_radius: 20e-6, edge_radius: 2e-6, pressure: -800, contact: {mode: sliding, "
      "friction: 0.1}}}");
  const Scene scene = parseScene(node, "scene.yaml");
  ASSERT_TRUE(scene.holding_pipette.mouth);
  EXPECT_EQ(scene.holding_pipette.mouth->inner_radius, 8e-6);
  EXPECT_EQ(scene.holding_pipette.mouth->outer_radius, 20e-6);
  EXPECT_EQ(scene.holding_pipette.mouth->edge_radius, 2e-6);
  EXPECT_EQ(scene.holding_pipette.mouth->pressure, -800);
  EXPECT_EQ(scene.holding_pipette.mouth->contact.mode, "sliding");
  EXPECT_EQ(scene.holding_pipette.mouth->contact.friction, 0.1);
  EXPECT_FALSE(parseScene(YAML::Load(kLayered), "scene.yaml").holding_pipette.mouth);
}

/// What test/reference/layered.csv and hemisphere.csv are about.
TEST(Scene, TheScenesOfTheReferencesAreThose) {
  const Scene layered = loadScene(kCells + "mouse_oocyte_layered.yaml");
  ASSERT_EQ(layered.cell.layers.size(), 2u);
  const Scene::Layer &zona = layered.cell.layers[0], &cytoplasm = layered.cell.layers[1];
  EXPECT_EQ(layered.cell.diameter(), 56e-6);
  EXPECT_NEAR(zona.outer_radius - cytoplasm.outer_radius, 4e-6, 1e-15);
  EXPECT_EQ(zona.material.young_modulus, 17.9e3);
  EXPECT_EQ(cytoplasm.material.young_modulus, 1e3);
  for (const Scene::Layer& layer : layered.cell.layers) {
    EXPECT_EQ(layer.material.model, "neo_hookean");
    EXPECT_EQ(layer.material.poisson_ratio, 0.49);
    EXPECT_EQ(layer.surface_tension, 0);
  }
  EXPECT_EQ(layered.needle.tip.shape, "disc");
  EXPECT_EQ(layered.needle.tip.radius, 3e-6);

  const Scene pipette = loadScene(kCells + "mouse_oocyte_pipette.yaml");
  EXPECT_EQ(pipette.needle.tip.shape, "hemisphere");
  EXPECT_EQ(pipette.needle.tip.edgeRadius(), 3e-6);
  EXPECT_EQ(pipette.needle.contact.mode, "sticking");
  EXPECT_EQ(pipette.cell.material().model, "neo_hookean");
  EXPECT_EQ(pipette.cell.diameter(), 56e-6);
}

TEST(Scene, OptionalKeysHaveDefaults) {
  const Scene scene = parseScene(YAML::Load(kGood), "scene.yaml");
  ASSERT_EQ(scene.cell.layers.size(), 1u);
  EXPECT_EQ(scene.cell.layers[0].name, "cell");
  EXPECT_EQ(scene.cell.layers[0].outer_radius, 28e-6);
  EXPECT_EQ(scene.cell.layers[0].surface_tension, 0);
  EXPECT_TRUE(scene.cell.material().viscoelasticity.empty());
  EXPECT_EQ(scene.needle.contact.mode, "sticking");
  EXPECT_EQ(scene.needle.contact.friction, 0);
  EXPECT_EQ(scene.needle.tip.edgeRadius(), 0);
  EXPECT_TRUE(scene.cell.puncture.layers.empty());
  EXPECT_EQ(scene.mesh.refinement.zone, 5);
  EXPECT_EQ(scene.mesh.refinement.density, 5);
  EXPECT_DOUBLE_EQ(scene.meshSize(), 3e-6 * 5);
}

TEST(Scene, ReadsOptionalKeys) {
  YAML::Node node = YAML::Load(kGood);
  node["needle"]["offset"] = YAML::Load("[1e-6, -2e-6]");
  node["mesh"] = YAML::Load("{size: 9e-6, refinement: {zone: 4, density: 3}}");
  node["cell"]["puncture"] = YAML::Load("{force: 1e-6}");
  const Scene scene = parseScene(node, "scene.yaml");
  EXPECT_EQ(scene.needle.offset, Eigen::Vector2d(1e-6, -2e-6));
  EXPECT_EQ(scene.meshSize(), 9e-6);
  EXPECT_EQ(scene.mesh.refinement.zone, 4);
  EXPECT_EQ(scene.mesh.refinement.density, 3);
  ASSERT_EQ(scene.cell.puncture.layers.size(), 1u);
  EXPECT_EQ(scene.cell.puncture.layers[0].name, "zona");
  EXPECT_EQ(scene.cell.puncture.layers[0].force, 1e-6);
}

TEST(Scene, ReadsRequirements) {
  YAML::Node node = YAML::Load(kGood);
  EXPECT_EQ(parseScene(node, "scene.yaml").requirements.rate, 1000);
  node["requirements"] = YAML::Load("{force_error: 0.05, rate: 500}");
  const Scene::Requirements needed = parseScene(node, "scene.yaml").requirements;
  EXPECT_EQ(needed.force_error, 0.05);
  EXPECT_EQ(needed.rate, 500);
  node["requirements"] = YAML::Load("{force_error: 0, speed: 1}");
  expectIn(errorsOf(node), {"requirements/force_error = 0", "requirements/speed"});
}

TEST(Scene, ReadsLayers) {
  YAML::Node node = YAML::Load(kLayered);
  for (const char* diameter : {"", "56e-6", "56.00005e-6"}) {
    if (*diameter) node["cell"]["diameter"] = diameter;
    const Scene scene = parseScene(node, "scene.yaml");
    ASSERT_EQ(scene.cell.layers.size(), 2u);
    EXPECT_EQ(scene.radius(), 28e-6);
    EXPECT_EQ(scene.cell.layers[0].name, "zona");
    EXPECT_EQ(scene.cell.layers[0].material.young_modulus, 17.9e3);
    EXPECT_EQ(scene.cell.layers[0].surface_tension, 0);
    EXPECT_EQ(scene.cell.layers[1].name, "cytoplasm");
    EXPECT_EQ(scene.cell.layers[1].outer_radius, 24e-6);
    EXPECT_EQ(scene.cell.layers[1].material.model, "corotated");
    EXPECT_EQ(scene.cell.layers[1].material.poisson_ratio, 0.45);
    EXPECT_EQ(scene.cell.layers[1].surface_tension, 1e-4);
  }
  node["cell"]["diameter"] = "56.0001e-6";
  expectIn(errorsOf(node), {"cell/diameter = 56.0001e-6: must be twice cell/layers/0/outer_radius = 2.8e-05 m"});
}

TEST(Scene, ReadsMaterialsThatRelaxAndSurfaceTension) {
  YAML::Node node = YAML::Load(kGood);
  node["cell"]["surface_tension"] = 2e-3;
  node["cell"]["material"] = YAML::Load(R"({model: mooney_rivlin, young_modulus: 5e3, poisson_ratio: 0.4,
    mooney_ratio: 0.5, viscoelasticity: {prony: [{modulus_ratio: 0.3, relaxation_time: 0.1},
    {modulus_ratio: 2, relaxation_time: 5}], viscosity: 7}})");
  const Scene::Layer layer = parseScene(node, "scene.yaml").cell.layers.at(0);
  EXPECT_EQ(layer.surface_tension, 2e-3);
  EXPECT_EQ(layer.material.model, "mooney_rivlin");
  EXPECT_EQ(layer.material.mooney_ratio, 0.5);
  const ViscoelasticityConfig& relaxing = layer.material.viscoelasticity;
  ASSERT_EQ(relaxing.prony.size(), 2u);
  EXPECT_EQ(relaxing.prony[0].modulus_ratio, 0.3);
  EXPECT_EQ(relaxing.prony[0].relaxation_time, 0.1);
  EXPECT_EQ(relaxing.prony[1].modulus_ratio, 2);
  EXPECT_EQ(relaxing.prony[1].relaxation_time, 5);
  EXPECT_EQ(relaxing.viscosity, 7);
}

TEST(Scene, ReadsRoundedTipsThatSlide) {
  YAML::Node node = YAML::Load(kGood);
  node["needle"]["tip"] = YAML::Load("{shape: rounded_flat, radius: 3e-6, edge_radius: 0.5e-6}");
  node["needle"]["contact"] = YAML::Load("{mode: sliding, friction: 0.2}");
  node["needle"]["offset"] = YAML::Load("[0, 26.5e-6]");  // 0.946 of the radius
  const Scene::Needle needle = parseScene(node, "scene.yaml").needle;
  EXPECT_EQ(needle.tip.shape, "rounded_flat");
  EXPECT_EQ(needle.tip.edgeRadius(), 0.5e-6);
  EXPECT_EQ(needle.contact.mode, "sliding");
  EXPECT_EQ(needle.contact.friction, 0.2);
  EXPECT_EQ(needle.offset.y(), 26.5e-6);
}

}  // namespace
}  // namespace microinjection
