// Whatever number a material has: a scene reads it, checks it, and surrogate data of another value are of another cell.

#include "cell/material/material_parameter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "cell/model/scene_description.h"
#include "cell/model/similarity.h"
#include "scene_texts.h"

namespace microinjection {
namespace {

class MaterialParameterTest : public testing::TestWithParam<MaterialParameter> {
 protected:
  /// A cell of two layers, the inner one of a model that has the number.
  MaterialParameterTest() : text_(YAML::Load(kLayered)) {
    if (!GetParam().ofAllModels()) inner()["model"] = GetParam().model;
    scene_ = parseScene(text_, "scene.yaml");
  }
  YAML::Node inner() { return text_["cell"]["layers"][1]["material"]; }
  double of(const Scene& scene) const { return scene.cell.layers[1].material.*GetParam().value; }

  YAML::Node text_;
  Scene scene_;
};

TEST_P(MaterialParameterTest, IsReadFromAScene) {
  const double changed = 0.9 * of(scene_);
  ASSERT_TRUE(GetParam().allowed.contains(changed));
  inner()[GetParam().name] = changed;
  EXPECT_EQ(of(parseScene(text_, "scene.yaml")), changed);
  if (GetParam().ofAllModels()) {
    inner().remove(GetParam().name);
    expectIn(errorsOf(text_), {GetParam().name, "missing"});
  } else {
    inner()["model"] = "neo_hookean";
    expectIn(errorsOf(text_), {GetParam().name, "must be left out", GetParam().model});
  }
}

TEST_P(MaterialParameterTest, IsChecked) {
  scene_.cell.layers[1].material.*GetParam().value = std::numeric_limits<double>::quiet_NaN();
  try {
    scene_.cell.layers[1].material.validate();
    FAIL() << "not a number is accepted";
  } catch (const ConfigError& error) {
    expectIn(error.what(), {GetParam().name});
  }
}

/// Else a cache of surrogate data would serve the old material in silence.
TEST_P(MaterialParameterTest, MakesAnotherCellOfPreparedData) {
  Scene other = scene_;
  other.cell.layers[1].material.*GetParam().value *= 0.9;
  EXPECT_NE(describeCellAndTip(other), describeCellAndTip(scene_));
  EXPECT_NE(describeCellAndTip(withoutDimension(other)), describeCellAndTip(withoutDimension(scene_)));
}

TEST_P(MaterialParameterTest, ScalesWithTheCellsModulus) {
  Scene stiffer = scene_;
  for (Scene::Layer& layer : stiffer.cell.layers) {
    for (const MaterialParameter& each : materialParameters()) layer.material.*each.value *= std::pow(3, each.stresses);
    layer.surface_tension *= 3;
  }
  stiffer.needle.contact.adhesion_energy *= 3;
  EXPECT_EQ(of(withoutDimension(stiffer)), of(withoutDimension(scene_)));
}

INSTANTIATE_TEST_SUITE_P(All, MaterialParameterTest, testing::ValuesIn(materialParameters()),
                         [](const auto& info) { return std::string(info.param.name); });

/// A member of MaterialConfig that is not in the list would be forgotten in all of this.
TEST(MaterialParameters, AreAllNumbersOfAMaterial) {
  struct Numbers {
    std::string model;
    double numbers[5];
    ViscoelasticityConfig viscoelasticity;
  };
  static_assert(sizeof(Numbers) == sizeof(MaterialConfig), "enter the new number in materialParameters(), and here");
  EXPECT_EQ(materialParameters().size(), 5U);
  std::set<std::string> names;
  for (const MaterialParameter& each : materialParameters()) names.insert(each.name);
  EXPECT_EQ(names.size(), materialParameters().size());
}

}  // namespace
}  // namespace microinjection
