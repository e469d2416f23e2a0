#include "cell/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

const std::string kCells = MICROINJECTION_SOURCE_DIR "/config/cells/";

constexpr char kGood[] = R"(
cell: {diameter: 56e-6, material: {model: neo_hookean, young_modulus: 17.9e3, poisson_ratio: 0.49}}
holding_pipette: {contact_radius: 10e-6}
needle: {tip: {shape: disc, radius: 3e-6}}
)";

std::string errorsOf(const YAML::Node& node) {
  try {
    parseScene(node, "scene.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Scene, ReadsTheMouseOocytes) {
  for (const auto& [file, model] :
       {std::pair("mouse_oocyte.yaml", "neo_hookean"), std::pair("mouse_oocyte_linear.yaml", "linear"),
        std::pair("mouse_oocyte_st_venant_kirchhoff.yaml", "st_venant_kirchhoff")}) {
    const Scene scene = loadScene(kCells + file);
    EXPECT_EQ(scene.cell.material.model, model);
    EXPECT_EQ(scene.cell.diameter, 56e-6);  // Table I
    EXPECT_EQ(scene.cell.material.young_modulus, 17.9e3);
    EXPECT_EQ(scene.cell.material.poisson_ratio, 0.49);
    EXPECT_EQ(scene.cell.puncture_force, 7.5e-6);
    EXPECT_EQ(scene.holding_pipette.contact_radius, 10e-6);
    EXPECT_EQ(scene.needle.tip.radius, 3e-6);
    EXPECT_EQ(scene.needle.offset, Eigen::Vector2d(0, 0));
  }
}

TEST(Scene, OptionalKeysHaveDefaults) {
  const Scene scene = parseScene(YAML::Load(kGood), "scene.yaml");
  EXPECT_TRUE(std::isinf(scene.cell.puncture_force));
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
  EXPECT_EQ(scene.cell.puncture_force, 1e-6);
}

TEST(Scene, NamesEveryBadKeyAtOnce) {
  YAML::Node node = YAML::Load(kGood);
  node["cell"]["material"]["model"] = "rubber";
  node["cell"]["material"]["poisson_ratio"] = 0.5;
  node["cell"]["diametre"] = 1;
  node["needle"]["tip"]["shape"] = "cone";
  node["holding_pipette"].remove("contact_radius");
  node["mesh"]["size"] = -1;
  const std::string text = errorsOf(node);
  for (const char* part :
       {"scene.yaml: cell/material/model = rubber: must be one of: linear, st_venant_kirchhoff, neo_hookean",
        "cell/material/poisson_ratio = 0.5: must be a number in (-1, 0.5)", "cell/diametre: unknown key",
        "needle/tip/shape = cone: must be one of: disc", "holding_pipette/contact_radius is missing",
        "mesh/size = -1: must be a number in (0, inf)"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
}

TEST(Scene, RefusesGeometryThatDoesNotFit) {
  const auto with = [](const char* section, const char* key, const char* value) {
    YAML::Node node = YAML::Load(kGood);
    node[section][key] = YAML::Load(value);
    return errorsOf(node);
  };
  EXPECT_NE(with("needle", "offset", "[25e-6, 0]").find("needle/offset"), std::string::npos);
  EXPECT_NE(with("holding_pipette", "contact_radius", "27e-6").find("holding_pipette/contact_radius = 2.7e-05"),
            std::string::npos);
  EXPECT_NE(with("mesh", "size", "40e-6").find("mesh/size = 4e-05"), std::string::npos);
  EXPECT_NE(with("mesh", "refinement", "{density: 0.5}").find("mesh/refinement/density"), std::string::npos);
  EXPECT_EQ(with("needle", "offset", "[20e-6, 0]"), "");
}

TEST(Scene, ValidateGuardsScenesMadeInCode) {
  Scene scene;
  EXPECT_NO_THROW(scene.validate());
  scene.cell.diameter = 0;
  scene.cell.material.young_modulus = -1;
  try {
    scene.validate();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("cell/diameter = 0"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("young_modulus = -1"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
