#include "surrogate/serve_needle.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

/// With a cache of its own, in which nothing was prepared.
class ServeNeedle : public testing::Test {
 protected:
  void SetUp() override { setenv("XDG_CACHE_HOME", (testing::TempDir() + "serve_needle_cache").c_str(), 1); }

  static Scene pipette() {
    Scene scene;
    scene.needle.tip.shape = "hemisphere";
    return scene;
  }

  static std::string refusal(const Scene& scene, const std::string& model) {
    try {
      serveNeedle(scene, model, {}, "a.yaml");
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(ServeNeedle, AnUnpreparedRoundedTipIsLiveWithAWarning) {
  CellTrackerConfig config;
  config.fixed_period = true;
  const ServedCell served = serveNeedle(pipette(), "auto", config, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.said, "not prepared; run: rosrun cell_microinjection prepare --scene a.yaml")) << served.said;
  EXPECT_TRUE(has(served.said, "live: P2-P0")) << served.said;
  EXPECT_TRUE(has(served.said, "too large")) << served.said;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < 200; ++i) served.cell->step({0, 0, 27.5e-6}, up, 1e-3 * i);
  const TipForce force = served.cell->step({0, 0, 27.5e-6}, up, 0.2);
  EXPECT_TRUE(force.trusted) << served.cell->distrust();
  EXPECT_GT(force.force.z(), 0);
}

TEST_F(ServeNeedle, AnUnpreparedDiscIsLiveOnLinearTetrahedra) {
  Scene disc;
  disc.mesh.size = 20e-6;
  const ServedCell served = serveNeedle(disc, "auto", {}, "a.yaml");
  EXPECT_FALSE(served.as_required);
  EXPECT_TRUE(has(served.said, "live: P1 tetrahedra, whose force is too large")) << served.said;
}

TEST_F(ServeNeedle, PreparedRefusesWhatIsNot) {
  EXPECT_TRUE(has(refusal(pipette(), "prepared"), "not prepared; run: rosrun")) << refusal(pipette(), "prepared");
  Scene rubbing = pipette();
  rubbing.needle.contact = {"sliding", 0.2};
  EXPECT_TRUE(has(refusal(rubbing, "prepared"), "friction = 0.2")) << refusal(rubbing, "prepared");
}

TEST_F(ServeNeedle, LiveIsServedAsAskedFor) {
  const ServedCell served = serveNeedle(pipette(), "live", {}, "a.yaml");
  EXPECT_TRUE(served.as_required);
  EXPECT_TRUE(has(served.said, "as asked for: P2-P0")) << served.said;
}

TEST_F(ServeNeedle, ATensegrityIsServedLiveWithoutAWarning) {
  const Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tensegrity.yaml");
  const ServedCell served = serveNeedle(scene, "auto", {}, "a.yaml");
  EXPECT_TRUE(served.as_required);
  EXPECT_TRUE(has(served.said, "solved live: tensegrity of ")) << served.said;
  EXPECT_FALSE(served.cell->picture().members.empty());
  EXPECT_TRUE(has(refusal(scene, "prepared"), "cell/model = tensegrity")) << refusal(scene, "prepared");
}

/// What has a memory of its own, or rubs, is no prepared cell.
TEST_F(ServeNeedle, WhatCannotBePreparedIsLive) {
  Scene viscous = pipette();
  viscous.cell.material().viscoelasticity.viscosity = 20;
  Scene rubbing = pipette();
  rubbing.needle.contact = {"sliding", 0.2};
  for (const Scene& scene : {viscous, rubbing}) {
    const ServedCell served = serveNeedle(scene, "auto", {}, "a.yaml");
    EXPECT_FALSE(served.as_required);
    EXPECT_TRUE(has(served.said, "cannot be prepared (")) << served.said;
    EXPECT_TRUE(has(served.said, "so it is live: P2-P0")) << served.said;
  }
}

}  // namespace
}  // namespace microinjection
