// Scenes that are refused, and what the messages say.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "cell/model/plausible_scene.h"
#include "cell/model/scene_texts.h"

namespace microinjection {
namespace {

TEST(SceneCheck, NamesEveryBadKeyAtOnce) {
  YAML::Node node = YAML::Load(kGood);
  node["cell"]["material"]["model"] = "rubber";
  node["cell"]["material"]["poisson_ratio"] = 0.5;
  node["cell"]["material"]["viscoelasticity"] = YAML::Load("{prony: [{modulus_ratio: 0}], viscosity: -1, damping: 1}");
  node["cell"]["surface_tension"] = -1;
  node["cell"]["diametre"] = 1;
  node["cell"]["puncture"] = YAML::Load("{force: 0}");
  node["needle"]["tip"]["shape"] = "cone";
  node["needle"]["contact"] = YAML::Load("{mode: glued, friction: -1}");
  node["holding_pipette"].remove("contact_radius");
  node["mesh"]["size"] = -1;
  const std::string text = errorsOf(node);
  expectIn(text, {"scene.yaml: cell/material/model = rubber: must be one of: linear, st_venant_kirchhoff, neo_hookean",
                  "cell/material/poisson_ratio = 0.5: must be a number in (-1, 0.5)",
                  "cell/material/viscoelasticity/prony/0/modulus_ratio = 0: must be a number in (0, inf)",
                  "cell/material/viscoelasticity/prony/0/relaxation_time is missing",
                  "cell/material/viscoelasticity/viscosity = -1: must be a number in [0, inf) Pa s",
                  "cell/material/viscoelasticity/damping: unknown key",
                  "cell/surface_tension = -1: must be a number in [0, inf) N/m", "cell/diametre: unknown key",
                  "cell/puncture/force = 0: must be a number in (0, inf) N",
                  "needle/tip/shape = cone: must be one of: disc, hemisphere, rounded_flat",
                  "needle/contact/mode = glued: must be one of: sticking, sliding",
                  "needle/contact/friction = -1: must be a number in [0, inf)",
                  "holding_pipette/contact_radius is missing", "mesh/size = -1: must be a number in (0, inf) m"});
}

TEST(SceneCheck, AdhesionMembraneAndStretchAreStrict) {
  YAML::Node node = YAML::Load(kGood);
  node["needle"]["contact"] = YAML::Load("{adhesion: {energy: 1e-3, range: 1e-7}}");
  node["cell"]["biomembrane"] = YAML::Load("{thickness: 4e-6, dimple_radius: 1e-6}");
  node["mesh"]["stretch"] = 2;
  expectIn(errorsOf(node), {"needle/contact/adhesion/energy = 0.001 J/m^2: must be left out: a disc never parts",
                            "cell/biomembrane/dimple_radius = 1e-06 m: must be above needle/tip/radius"});
  node["needle"]["tip"] = YAML::Load("{shape: hemisphere, radius: 3e-6}");
  node["cell"]["biomembrane"]["dimple_radius"] = 20e-6;
  EXPECT_EQ(errorsOf(node), "");
  const Scene scene = parseScene(node, "scene.yaml");
  EXPECT_EQ(scene.needle.contact.adhesion_energy, 1e-3);
  EXPECT_EQ(scene.needle.contact.adhesion_range, 1e-7);
  EXPECT_EQ(scene.cell.biomembrane->thickness, 4e-6);
  EXPECT_EQ(scene.mesh.stretch, 2);
  node["needle"]["contact"] = YAML::Load("{adhesion: {energy: 0, reach: 1e-7}}");
  node["cell"]["biomembrane"] = YAML::Load("{thickness: -1}");
  node["mesh"]["stretch"] = 5;
  expectIn(errorsOf(node),
           {"needle/contact/adhesion/energy = 0: must be a number in (0, inf) J/m^2",
            "needle/contact/adhesion/range is missing", "needle/contact/adhesion/reach: unknown key",
            "cell/biomembrane/thickness = -1: must be a number in (0, inf) m",
            "cell/biomembrane/dimple_radius is missing", "mesh/stretch = 5: must be a number in [1, 4]"});
}

TEST(SceneCheck, RefusesLayersThatDoNotFit) {
  const auto with = [](const char* change) {
    YAML::Node node = YAML::Load(kLayered);
    const YAML::Node changes = YAML::Load(change);
    for (const auto& item : changes) node["cell"]["layers"][1][item.first.Scalar()] = item.second;
    return errorsOf(node);
  };
  EXPECT_EQ(with("{}"), "");
  EXPECT_EQ(with("{outer_radius: 27.944e-6}"), "");  // 1/500 of 28 um is 0.056 um
  expectIn(with("{outer_radius: 27.95e-6, surface_tension: -1, young_modulus: 3}"),
           {"scene.yaml: cell/layers/1/surface_tension = -1: must be a number in [0, inf) N/m",
            "cell/layers/1/young_modulus: unknown key"});
  expectIn(with("{outer_radius: 27.95e-6, name: zona}"),
           {"cell/layers/0 (zona) is 5e-08 m thick: must be at least 1/500 of the cell's radius, 5.6e-08 m",
            "cell/layers/1/name = zona: must be a name that no other layer has"});
  expectIn(with("{outer_radius: 0.05e-6}"), {"cell/layers/1 (cytoplasm) is 5e-08 m thick"});
  expectIn(with("{outer_radius: 28e-6, name: ''}"),
           {"cell/layers/1/outer_radius = 2.8e-05 m: must be below the 2.8e-05 m of the layer around it",
            "cell/layers/1/name = : must be"});
}

TEST(SceneCheck, TakesEitherOneMaterialOrLayers) {
  YAML::Node both = YAML::Load(kLayered);
  both["cell"]["material"] = YAML::Load("{model: linear, young_modulus: 1, poisson_ratio: 0}");
  both["cell"]["surface_tension"] = 1;
  expectIn(errorsOf(both), {"cell/material = {model: linear, young_modulus: 1, poisson_ratio: 0}: must be left out",
                            "cell/surface_tension = 1: must be left out where there are layers"});
  YAML::Node neither = YAML::Load(kGood);
  neither["cell"] = YAML::Load("{}");
  expectIn(errorsOf(neither), {"cell/material: is missing; or give layers", "cell/diameter is missing"});
  neither["cell"] = YAML::Load("{layers: []}");
  expectIn(errorsOf(neither), {"cell/layers = []: must have at least one layer"});
}

TEST(SceneCheck, RefusesKeysThatBelongToSomethingElse) {
  const auto with = [](const char* needle, const char* material = "{}") {
    YAML::Node node = YAML::Load(kGood);
    node["needle"] = YAML::Load(needle);
    const YAML::Node changes = YAML::Load(material);
    for (const auto& item : changes) node["cell"]["material"][item.first.Scalar()] = item.second;
    return errorsOf(node);
  };
  expectIn(
      with("{tip: {shape: disc, radius: 3e-6, edge_radius: 1e-6}, contact: {mode: sliding}}", "{mooney_ratio: 0.5}"),
      {"needle/tip/edge_radius = 1e-6: must be left out: it belongs to shape rounded_flat only",
       "needle/contact/mode = sliding: must be sticking: the disc's sharp edge is the paper's nodal contact, which "
       "sticks; rounded_flat slides",
       "cell/material/mooney_ratio = 0.5: must be left out: it belongs to model mooney_rivlin only"});
  expectIn(with("{tip: {shape: hemisphere, radius: 3e-6, edge_radius: 3e-6}, contact: {friction: 0}}"),
           {"needle/tip/edge_radius = 3e-6: must be left out",
            "needle/contact/friction = 0: must be left out: it belongs to mode sliding only"});
  expectIn(with("{tip: {shape: rounded_flat, radius: 3e-6}}"), {"needle/tip/edge_radius is missing"});
  expectIn(with("{tip: {shape: rounded_flat, radius: 3e-6, edge_radius: 3.1e-6}}"),
           {"needle/tip/edge_radius = 3.1e-06 m: must be from 1/20 of the tip's radius to all of it, 3e-06 m"});
  EXPECT_EQ(
      with("{tip: {shape: rounded_flat, radius: 3e-6, edge_radius: 3e-6}}", "{model: mooney_rivlin, mooney_ratio: 1}"),
      "");
  expectIn(with("{tip: {shape: disc, radius: 3e-6}}", "{model: mooney_rivlin, mooney_ratio: 1.1}"),
           {"cell/material/mooney_ratio = 1.1: must be a number in [0, 1]"});
}

TEST(SceneCheck, RefusesGeometryThatDoesNotFit) {
  const auto with = [](const char* section, const char* key, const char* value, const char* shape = "disc") {
    YAML::Node node = YAML::Load(kGood);
    node["needle"]["tip"]["shape"] = shape;
    node[section][key] = YAML::Load(value);
    return errorsOf(node);
  };
  expectIn(with("needle", "offset", "[25e-6, 0]"),
           {"needle/offset (its length) = 2.5e-05 m: must be with the tip's radius below 0.95"});
  EXPECT_EQ(with("needle", "offset", "[20e-6, 0]"), "");
  EXPECT_EQ(with("needle", "offset", "[25e-6, 0]", "hemisphere"), "");
  expectIn(with("needle", "offset", "[26.7e-6, 0]", "hemisphere"), {"needle/offset (its length) = 2.67e-05 m"});
  expectIn(with("needle", "tip", "{shape: hemisphere, radius: 29e-6}"), {"needle/tip/radius = 2.9e-05 m"});
  expectIn(with("needle", "tip", "{shape: disc, radius: 27e-6}"), {"needle/tip/radius = 2.7e-05 m"});
  expectIn(with("holding_pipette", "contact_radius", "27e-6"), {"holding_pipette/contact_radius = 2.7e-05 m"});
  expectIn(with("mesh", "size", "40e-6"), {"mesh/size = 4e-05 m"});
  expectIn(with("mesh", "refinement", "{density: 0.5}"), {"mesh/refinement/density"});
}

TEST(SceneCheck, TakesTheTipsAndCellsThatThereAre) {
  for (const double diameter : {20e-6, 56e-6, 120e-6, 1.2e-3}) {
    for (const double radius : {0.5e-6, 1e-6, 3e-6, 5e-6, 10e-6}) {
      for (const std::string& shape : tipShapes()) {
        if (shape == "disc" && radius > 0.9 * diameter / 2) continue;  // as wide as the cell
        Scene scene;
        scene.cell.layers.front().outer_radius = diameter / 2;
        scene.holding_pipette.contact_radius = diameter / 6;
        scene.needle.tip = {shape, radius, shape == "rounded_flat" ? radius / 3 : 0};
        EXPECT_NO_THROW(scene.validate()) << diameter << " " << radius << " " << shape;
        EXPECT_LE(scene.meshSize(), 0.3 * diameter);
        EXPECT_GE(scene.meshSize(), 0.05 * diameter);
      }
    }
  }
}

/// Of each kind of quantity, a number in the unit that people write.
TEST(SceneCheck, RefusesValuesInAnotherUnit) {
  const auto with = [](const std::vector<std::string>& path, const char* value, const char* text = kLayered) {
    YAML::Node node = YAML::Load(text), at;
    at.reset(node);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const YAML::Node next = at.IsSequence() ? at[std::stoul(path[i])] : at[path[i]];
      at.reset(next);
    }
    at[path.back()] = YAML::Load(value);
    return errorsOf(node);
  };
  expectIn(with({"cell", "diameter"}, "56", kGood),
           {"scene.yaml: cell/diameter = 56 m: must be 1e-6 .. 5e-3 m; 56 um would be 5.6e-5"});
  expectIn(with({"cell", "layers", "0", "outer_radius"}, "28"),
           {"cell/layers/0/outer_radius = 28 m: must be 5e-7 .. 2.5e-3 m; 28 um would be 2.8e-5"});
  expectIn(with({"cell", "layers", "1", "material", "young_modulus"}, "0.5"),
           {"cell/layers/1/material/young_modulus = 0.5 Pa: must be 1 .. 1e9 Pa; 0.5 kPa would be 500"});
  expectIn(with({"cell", "layers", "1", "surface_tension"}, "35"),
           {"cell/layers/1/surface_tension = 35 N/m: must be 0 .. 1 N/m; 35 mN/m would be 0.035"});
  expectIn(with({"cell", "material", "viscoelasticity"}, "{prony: [{modulus_ratio: 1, relaxation_time: 1e8}]}", kGood),
           {"cell/material/viscoelasticity/prony/0/relaxation_time = 1e+08 s: must be 1e-6 .. 1e6 s"});
  expectIn(with({"cell", "puncture"}, "{force: 7.5}"), {"cell/puncture/force = 7.5 N: must be 1e-13 .. 1 N; 7.5 uN"});
  expectIn(with({"cell", "puncture"}, "{layers: [{name: a, depth: 45}]}"),
           {"cell/puncture/layers/0/depth = 45 m: must be 1e-9 .. 5e-3 m; 45 um"});
  expectIn(with({"cell", "puncture"}, "{layers: [{name: a, strain: 15, dimple_radius: 1e-5}]}"),
           {"cell/puncture/layers/0/strain = 15: must be 1e-4 .. 10; 15 % would be 0.15"});
  expectIn(with({"needle", "tip", "radius"}, "3"), {"needle/tip/radius = 3 m: must be 1e-8 .. 1e-3 m; 3 um"});
  expectIn(with({"needle", "offset"}, "[0, -2]"),
           {"needle/offset = -2 m: must be -5e-3 .. 5e-3 m; -2 um would be -2e-6"});
  expectIn(with({"holding_pipette", "contact_radius"}, "10"), {"holding_pipette/contact_radius = 10 m: must be"});
  expectIn(with({"mesh"}, "{size: 5}"), {"mesh/size = 5 m: must be 1e-9 .. 2.5e-3 m; 5 um"});
}

TEST(SceneCheck, ADimensionlessSceneHasNoPlausibleRange) {
  const YAML::Node node = YAML::Load(
      "{cell: {diameter: 2, material: {model: neo_hookean, young_modulus: 1, poisson_ratio: 0.4}},"
      " holding_pipette: {contact_radius: 0.3}, needle: {tip: {shape: hemisphere, radius: 0.1}}}");
  EXPECT_EQ(parseDimensionlessScene(node, "family.yaml").cell.diameter(), 2);
  expectIn(errorsOf(node), {"cell/diameter = 2 m: must be"});
}

TEST(SceneCheck, AFilesErrorsNameItsLines) {
  const std::string path = testing::TempDir() + "scene_check_test.yaml";
  const auto errors = [&](const std::string& tip_and_rest) {
    std::ofstream(path)
        << "# a cell\ncell:\n  layers:\n    - name: zona\n      outer_radius: 28\n      material: {model: "
           "linear, young_modulus: 1e3, poisson_ratio: 0.4}\nholding_pipette:\n  contact_radius: 10e-6\n"
        << "needle:\n  tip: {shape: disc, " << tip_and_rest;
    try {
      loadScene(path);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  expectIn(errors("radius: many}\n"), {(path + ", line 10: needle/tip/radius = many: must be a number").c_str()});
  const std::string two = errors("radius: 3}\n  offst: [0, 0]\n");
  expectIn(two, {(path + ", line 11: needle/offst: unknown key").c_str()});
  expectIn(errors("radius: 3}\n"),
           {(path + ", line 10: needle/tip/radius = 3 m").c_str(), "line 2: cell/diameter = 56 m"});
}

TEST(SceneCheck, ValidateGuardsScenesMadeInCode) {
  Scene scene;
  EXPECT_NO_THROW(scene.validate());
  EXPECT_EQ(scene.cell.diameter(), 56e-6);
  scene.cell.layers.front().outer_radius = 0;
  scene.cell.material().young_modulus = -1;
  scene.needle.contact.mode = "sliding";
  scene.needle.tip.edge_radius = 1e-6;
  const auto errors = [&]() -> std::string {
    try {
      scene.validate();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  expectIn(errors(), {"cell/diameter = 0", "cell/material/young_modulus = -1", "needle/contact/mode = sliding: must be",
                      "needle/tip/edge_radius = 1e-06 m: must be left out"});
  scene.cell.layers.push_back({"nucleus", -1e-6, {}, std::nan("")});
  scene.cell.layers.back().material.model = "rubber";
  expectIn(errors(), {"cell/layers/0/outer_radius = 0", "cell/layers/0/material/young_modulus = -1",
                      "cell/layers/1/outer_radius = -1e-06 m", "cell/layers/1/material/model = rubber",
                      "cell/layers/1/surface_tension = nan"});
  scene.cell.layers.clear();
  expectIn(errors(), {"cell/layers: must have at least one layer"});
}

TEST(SceneCheck, AMouthIsATubeThatTheCellCloses) {
  const auto with = [](const std::string& mouth, const char* needle = "{tip: {shape: hemisphere, radius: 3e-6}}") {
    YAML::Node node = YAML::Load(kGood);
    node["holding_pipette"] = YAML::Load("{mouth: " + mouth + "}");
    node["needle"] = YAML::Load(needle);
    return errorsOf(node);
  };
  const std::string good = "{inner_radius: 8e-6, outer_radius: 20e-6, edge_radius: 2e-6, pressure: -800}";
  EXPECT_EQ(with(good), "");
  expectIn(with(good, "{tip: {shape: disc, radius: 3e-6}}"),
           {"needle/tip/shape = disc: must be hemisphere or rounded_flat where suction holds the cell"});
  expectIn(with("{inner_radius: 8e-6, outer_radius: 8e-6, edge_radius: 2e-6, pressure: -800}"),
           {"holding_pipette/mouth/outer_radius = 8e-06 m: must be above the inner radius, 8e-06 m"});
  expectIn(with("{inner_radius: 8e-6, outer_radius: 20e-6, edge_radius: 7e-6, pressure: 20}"),
           {"mouth/pressure = 20 Pa: must be"});
  expectIn(with("{inner_radius: 8e-6, outer_radius: 20e-6, edge_radius: 7e-6, pressure: -800}"),
           {"mouth/edge_radius = 7e-06 m: must be above 0 and at most half of the wall, 6e-06 m"});
  expectIn(with("{inner_radius: 27e-6, outer_radius: 40e-6, edge_radius: 2e-6, pressure: -800}"),
           {"mouth/inner_radius = 2.7e-05 m: must be with edge_radius below 0.95 of the cell's radius", "swallows"});
  expectIn(with("{inner_radius: 8e-6, outer_radius: 20e-6, pressure: -800, suction: 3}"),
           {"mouth/edge_radius", "is missing", "suction"});
  YAML::Node both = YAML::Load(kGood);
  both["needle"] = YAML::Load("{tip: {shape: hemisphere, radius: 3e-6}}");
  both["holding_pipette"]["mouth"] = YAML::Load(good);
  expectIn(errorsOf(both), {"holding_pipette/contact_radius", "must be left out: suction holds the cell"});
}

}  // namespace
}  // namespace microinjection
