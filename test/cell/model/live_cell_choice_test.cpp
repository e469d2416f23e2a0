// Which cells are solved while the needle moves, by which elements, and which are refused.

#include <gtest/gtest.h>

#include <string>

#include "base/errors.h"
#include "cell/model/live_cell.h"
#include "cell/model/live_fem_cell.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

TEST(LiveFemCell, RefusesACellThatIsNotStableAtRest) {
  Scene scene = pipetteScene();
  scene.cell.layers.front().surface_tension = -1;
  EXPECT_THROW(LiveFemCell{scene}, ConfigError);
}

TEST(LiveFemCell, RefusesAdhesionWhichItWouldNotShow) {
  Scene scene = pipetteScene();
  scene.needle.contact.adhesion_energy = 2e-3;
  scene.needle.contact.adhesion_range = 0.5e-6;
  scene.validate();  // it is a good scene
  try {
    makeLiveCell(scene);
    FAIL() << "was served without adhesion";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("needle/contact/adhesion"), std::string::npos) << error.what();
  }
}

TEST(LiveCell, IsOfLinearTetrahedraOnlyWhereThoseCan) {
  Scene disc;
  disc.mesh.size = 20e-6;
  EXPECT_NE(makeLiveCell(disc)->description().find("P1"), std::string::npos);
  EXPECT_NE(makeLiveCell(pipetteScene())->description().find("P2-P0"), std::string::npos);
  Scene relaxing = disc;
  relaxing.cell.material().viscoelasticity.viscosity = 10;
  EXPECT_NE(makeLiveCell(relaxing)->description().find("P2-P0"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
