#include "operation/display/pipettes.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "base/errors.h"
#include "operation/display/display_config.h"
#include "soup_measures.h"

namespace microinjection {
namespace {

double frustum(double r0, double r1, double height) { return M_PI * height * (r0 * r0 + r0 * r1 + r1 * r1) / 3; }

std::string errorsOf(const std::string& yaml) {
  try {
    ConfigReader reader(YAML::Load(yaml), "display");
    DisplayConfig::read(reader);
    reader.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(DrawnInjectionPipette, HasItsSizesAtTenThousandTimes) {
  const DrawnInjectionPipette pipette;
  const TriangleSoup soup = glass(pipette);
  const RadialRange tip = radialRange(soup, -1e-9, 1e-9);
  EXPECT_NEAR(tip.largest, 0.03, 1e-9);
  EXPECT_NEAR(tip.least, 0.7 * 0.03, 1e-9);
  EXPECT_NEAR(radialRange(soup, 0, 10).largest, 0.1, 1e-9);
  EXPECT_NEAR(radialRange(soup, 1.2 - 1e-9, 1.2 + 1e-9).least, 0.07, 1e-9);
}

TEST(DrawnInjectionPipette, IsAClosedHollowGlassThatFacesOutwards) {
  const DrawnInjectionPipette pipette;
  const TriangleSoup soup = glass(pipette);
  EXPECT_TRUE(isClosed(soup));
  const double taper = (0.1 - 0.03) / std::tan(pipette.taper_angle);
  const double solid = frustum(0.03, 0.1, taper) + M_PI * 0.1 * 0.1 * (1.2 - taper);
  EXPECT_NEAR(signedVolume(soup), solid * (1 - 0.7 * 0.7) * polygonFactor(48), 1e-9);
}

TEST(DrawnInjectionPipette, ShowsOnlyTheTaperWhenItIsLongerThanWhatIsDrawn) {
  DrawnInjectionPipette pipette;
  pipette.length = 20e-6;
  EXPECT_NEAR(radialRange(glass(pipette), 0, 1).largest, 0.03 + 0.2 * std::tan(pipette.taper_angle), 1e-9);
}

TEST(DrawnHoldingPipette, IsNarrowestAtItsMouth) {
  const DrawnHoldingPipette pipette;
  const TriangleSoup soup = glass(pipette);
  EXPECT_TRUE(isClosed(soup));
  EXPECT_GT(signedVolume(soup), 0);
  const RadialRange rim = radialRange(soup, -1e-9, 1e-9);
  EXPECT_NEAR(rim.least, 0.1, 1e-9);
  EXPECT_NEAR(rim.largest, 0.1, 1e-9);
  const RadialRange all = radialRange(soup, -1, 1);
  EXPECT_NEAR(all.least, 0.1, 1e-9);
  EXPECT_NEAR(all.largest, 0.3, 1e-9);
  EXPECT_EQ(radialRange(soup, -1, -1e-9).largest, 0);  // nothing in front of the mouth
}

TEST(DrawnHoldingPipette, MouthFollowsTheOutermostHeldPoint) {
  const Mouth mouth = fitMouth({{0, 0, 0}, {3e-6, 4e-6, -1e-6}, {0, -6e-6, -1.5e-6}});
  EXPECT_DOUBLE_EQ(mouth.radius, 6e-6);
  EXPECT_DOUBLE_EQ(mouth.height, -1.5e-6);
}

TEST(DisplayConfig, NamesEveryErrorWithItsValue) {
  const std::string errors =
      errorsOf("{rate: 61, holding_pipette: {outer_radius: 5.0e-6}, injection_pipette: {bore_ratio: 1, colour: red}}");
  EXPECT_NE(errors.find("rate = 61: must be a number in (0, 60]"), std::string::npos) << errors;
  EXPECT_NE(errors.find("holding_pipette/outer_radius = 5.0e-6: must be above mouth_radius"), std::string::npos)
      << errors;
  EXPECT_NE(errors.find("injection_pipette/bore_ratio = 1"), std::string::npos) << errors;
  EXPECT_NE(errors.find("injection_pipette/colour: unknown key"), std::string::npos) << errors;
}

TEST(DisplayConfig, ReadsTheFileThatIsShipped) {
  ConfigReader reader(loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/display.yaml"), "display.yaml");
  const DisplayConfig config = DisplayConfig::read(reader);
  EXPECT_NO_THROW(reader.finish());
  EXPECT_DOUBLE_EQ(config.injection_pipette.tip_radius, 3e-6);
}

}  // namespace
}  // namespace microinjection
