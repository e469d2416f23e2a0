// What a scene says of puncture.

#include "cell/model/puncture_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cell/model/scene_description.h"
#include "cell/model/scene_texts.h"

namespace microinjection {
namespace {

YAML::Node with(const char* puncture) {
  YAML::Node node = YAML::Load(kGood);
  node["cell"]["puncture"] = YAML::Load(puncture);
  return node;
}

constexpr char kWhole[] = R"(
layers:
  - {name: zona, strain: 0.5, dimple_radius: 20e-6}
  - {name: oolemma, gap: 1e-6, stiffness: 0.05, depth: 3e-6}
shaft: {friction: 1e-7, adhesion: 2e-3, stiffness: 0.4, damping: 3, lateral_stiffness: 0.02}
relaxation_time: 1e-3
)";

TEST(PunctureConfig, ReadsEveryKey) {
  const PunctureConfig config = parseScene(with(kWhole), "scene.yaml").cell.puncture;
  ASSERT_EQ(config.layers.size(), 2u);
  EXPECT_EQ(config.layers[0].strain, 0.5);
  EXPECT_EQ(config.layers[0].dimple_radius, 20e-6);
  EXPECT_TRUE(std::isinf(config.layers[0].force) && std::isinf(config.layers[0].depth));
  EXPECT_EQ(config.layers[1].name, "oolemma");
  EXPECT_EQ(config.layers[1].gap, 1e-6);
  EXPECT_EQ(config.layers[1].stiffness, 0.05);
  EXPECT_EQ(config.layers[1].depth, 3e-6);
  EXPECT_EQ(config.shaft.friction, 1e-7);
  EXPECT_EQ(config.shaft.adhesion, 2e-3);
  EXPECT_EQ(config.shaft.stiffness, 0.4);
  EXPECT_EQ(config.shaft.damping, 3);
  EXPECT_EQ(config.shaft.lateral_stiffness, 0.02);
  EXPECT_EQ(config.relaxation_time, 1e-3);
}

TEST(PunctureConfig, ReadsToughness) {
  const PunctureConfig shorthand =
      parseScene(with("{toughness: 2.5, toughness_rate: {speed: 1e-4, exponent: 0.5}, barrier: 1e-12, "
                      "shaft: {coefficient: 0.3}}"),
                 "scene.yaml")
          .cell.puncture;
  ASSERT_EQ(shorthand.layers.size(), 1u);
  EXPECT_EQ(shorthand.layers[0].toughness, 2.5);
  EXPECT_EQ(shorthand.layers[0].barrier, 1e-12);
  EXPECT_EQ(shorthand.layers[0].toughness_rate.speed, 1e-4);
  EXPECT_EQ(shorthand.layers[0].toughness_rate.exponent, 0.5);
  EXPECT_TRUE(std::isinf(shorthand.layers[0].force));
  EXPECT_EQ(shorthand.shaft.coefficient, 0.3);
  const PunctureConfig layers = parseScene(with("{layers: [{name: zona, toughness: 4}]}"), "scene.yaml").cell.puncture;
  EXPECT_EQ(layers.layers[0].toughness, 4);
}

TEST(PunctureConfig, ToughnessStandsAloneAndBeginsOutermost) {
  expectIn(errorsOf(with("{force: 1e-6, toughness: 1}")), {"cell/puncture/toughness = 1: must be left out"});
  expectIn(errorsOf(with("{barrier: 1e-12}")), {"cell/puncture/barrier = 1e-12: must be left out"});
  expectIn(errorsOf(with("{force: 1e-6, toughness_rate: {speed: 1e-4, exponent: 1}}")),
           {"cell/puncture/toughness_rate"});
  expectIn(errorsOf(with("{toughness: 1, toughness_rate: {speed: 0}}")),
           {"cell/puncture/toughness_rate/speed = 0: must be a number in (0, inf) m/s",
            "cell/puncture/toughness_rate/exponent is missing"});
  expectIn(errorsOf(with("{toughness: 0}")), {"cell/puncture/toughness = 0: must be a number in (0, inf) J/m^2"});
  expectIn(errorsOf(with("{strength: 1}")), {"cell/puncture/strength = 1: must be left out: it belongs to toughness"});
  expectIn(errorsOf(with("{toughness: 1, strength: 1, toughness_rate: {speed: 1, exponent: 1}}")),
           {"cell/puncture/strength = 1: must be left out where there is a toughness_rate"});
  expectIn(errorsOf(with("{layers: [{name: zona, toughness: 1, force: 1e-6}, {name: b, toughness: 1, stiffness: 1}]}")),
           {"cell/puncture/layers/0/name = zona: must have one of force",
            "cell/puncture/layers/1/stiffness = 1: must be left out"});
  expectIn(errorsOf(with("{toughness: 1, strength: 1, barrier: 1e-12}")),
           {"cell/puncture/strength = 1: must be left out where there is a barrier"});
  expectIn(
      errorsOf(with("{layers: [{name: a, toughness: 1}, {name: b, toughness: 1}, {name: c, stiffness: 1, force: 1}]}")),
      {"cell/puncture/layers/2/name = c: must have a toughness, as the layer before it"});
  expectIn(errorsOf(with("{layers: [{name: zona, force: 1e-6}, {name: b, toughness: 1}]}")),
           {"cell/puncture/layers/1/toughness = 1: must be left out: the layer before it is not pierced by mechanics"});
  expectIn(errorsOf(with("{toughness: .inf}")), {"cell/puncture/toughness = .inf: must be a number"});
}

TEST(PunctureConfig, IsStrict) {
  expectIn(
      errorsOf(with("{layers: [{name: zona, gap: 1e-6, stiffness: 1, force: 1e-6, depth: 1e-6}, {force: -1}, "
                    "{name: nucleus, stiffness: 1, strain: 0.1}, {name: b, stiffness: 1, depth: 1e-6, "
                    "dimple_radius: 1e-5}], force: 1e-6, shaft: {friction: -1, drag: 2}, relaxation_time: 0}")),
      {"cell/puncture/layers/0/name = zona: must have one of force (N), depth (m), strain",
       "cell/puncture/layers/0/gap = 1e-6: must be left out", "cell/puncture/layers/0/stiffness = 1: must be left",
       "cell/puncture/layers/1/name is missing", "cell/puncture/layers/1/stiffness is missing",
       "cell/puncture/layers/1/force = -1: must be a number in (0, inf) N",
       "cell/puncture/layers/2/dimple_radius is missing",
       "cell/puncture/layers/3/dimple_radius = 1e-5: must be left out",
       "cell/puncture/force = 1e-6: must be left out where there are layers",
       "cell/puncture/shaft/friction = -1: must be a number in [0, inf) N", "cell/puncture/shaft/drag: unknown key",
       "cell/puncture/relaxation_time = 0: must be a number in (0, inf) s"});
  expectIn(errorsOf(with("{layers: []}")), {"cell/puncture/layers = []: must have at least one layer"});
  expectIn(errorsOf(with("{layers: [{name: a, strain: 1, dimple_radius: 3e-6}, {name: a, stiffness: 1, force: 1}]}")),
           {"cell/puncture/layers/0/dimple_radius = 3e-06 m: must be above needle/tip/radius",
            "cell/puncture/layers/1/name = a: must be a name that no other layer has"});
}

TEST(PunctureConfig, StrainIsTheConesStretch) {
  PunctureConfig::Layer layer;
  layer.dimple_radius = 7e-6;
  EXPECT_NEAR(layer.strainAt(3e-6, 3e-6), 0.25, 1e-15);  // 3, 4, 5
  EXPECT_NEAR(layer.strainAt(1e-8, 3e-6), 1e-16 / (2 * 16e-12), 1e-10);
}

/// What was prepared for a cell serves it however it is punctured.
TEST(PunctureConfig, IsNoPartOfThePreparedCell) {
  const Scene never = parseScene(YAML::Load(kGood), "scene.yaml"), scene = parseScene(with(kWhole), "scene.yaml");
  EXPECT_EQ(describeCellAndTip(scene), describeCellAndTip(never));
}

}  // namespace
}  // namespace microinjection
