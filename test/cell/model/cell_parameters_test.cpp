#include "cell/model/cell_parameters.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/errors.h"

namespace microinjection {
namespace {

Scene cell(const std::string& name) { return loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/" + name + ".yaml"); }

double valueOf(const Scene& scene, const std::string& name) {
  for (const CellParameter& parameter : cellParameters(scene)) {
    if (parameter.name == name) return parameter.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(CellParameters, OfALayeredCellAreReadAsTheyWereSet) {
  const Scene before = cell("mouse_oocyte_layered");
  EXPECT_NEAR(valueOf(before, "shell_thickness"), 4e-6, 1e-15);
  const Scene after = withParameters(before, {{"core_modulus", 2e3}, {"shell_thickness", 5e-6}, {"diameter", 80e-6}});
  EXPECT_NEAR(valueOf(after, "diameter"), 80e-6, 1e-15);
  EXPECT_NEAR(valueOf(after, "shell_thickness"), 5e-6, 1e-15);
  EXPECT_EQ(valueOf(after, "core_modulus"), 2e3);
  EXPECT_EQ(valueOf(after, "young_modulus"), valueOf(before, "young_modulus"));
  EXPECT_EQ(after.holding_pipette.contact_radius, before.holding_pipette.contact_radius);
}

TEST(CellParameters, ADiameterScalesAllLayers) {
  const Scene after = withParameters(cell("mouse_oocyte_layered"), {{"diameter", 112e-6}});
  EXPECT_NEAR(valueOf(after, "shell_thickness"), 8e-6, 1e-12);
}

TEST(CellParameters, ABadValueIsNamed) {
  const Scene scene = cell("mouse_oocyte_pipette");
  const auto error = [&](const CellParameter& parameter) {
    try {
      withParameters(scene, {parameter});
    } catch (const ConfigError& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  for (const char* name : {"diameter", "young_modulus", "poisson_ratio"}) {
    for (const double value : {kNan, kInf, -1.0, -kInf}) {
      EXPECT_NE(error({name, value}).find(name), std::string::npos) << name << ' ' << value;
    }
  }
  EXPECT_NE(error({"surface_tension", -1e-3}).find("surface_tension = -0.001"), std::string::npos);
  EXPECT_NE(error({"core_modulus", 1e3}).find("no parameter of this cell"), std::string::npos);
  EXPECT_NE(error({"diameter", 1e-6}), "") << "smaller than the holding pipette";
  EXPECT_EQ(error({"young_modulus", 15e3}), "");
}

}  // namespace
}  // namespace microinjection
