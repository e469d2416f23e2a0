#include "cell/estimation/rival_watch.h"

#include <gtest/gtest.h>

#include <random>

#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/family_member.h"
#include "cell/family/family_cell.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr char kZona[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_zona.yaml";

Scene layered() { return loadScene(kZona); }

Scene homogeneous() {
  Scene scene = layered();
  scene.cell.layers.resize(1);
  return scene;
}

/// Indents `truth` to `depth` (m), `lateral` (m) beside its axis, as the estimator of `estimated` sees it at a sensor
/// of 2 nN.
CellEstimate indent(const Scene& truth, const Scene& estimated, double depth, bool rivals, double lateral = 0) {
  static const auto families = loadFamilies(kFamilies);
  CellEstimator estimator(
      estimated, memberOf(estimated), {},
      rivals ? std::make_shared<const std::vector<RivalCell>>(rivalCells(families, estimated)) : nullptr);
  SurrogateContact cell(truth, memberOf(truth));
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 2e-9);
  const int count = static_cast<int>((5e-6 + depth) / 20e-9);
  for (int i = 0; i <= count; ++i) {
    const Eigen::Vector3d tip(lateral, 0, truth.radius() + 5e-6 - 20e-9 * i);
    estimator.add(1e-3 * i, tip, cell.step(tip).force.z() + normal(random));
    if (i % 20 == 0) estimator.update();
  }
  return estimator.update();
}

TEST(RivalWatch, AnotherCellIsInconsistentAndNamed) {
  const CellEstimate found = indent(layered(), homogeneous(), 12e-6, true);
  EXPECT_EQ(found.verdict, EstimateVerdict::kInconsistent);
  EXPECT_NE(found.reason.find("zona"), std::string::npos) << found.reason;
  EXPECT_NE(indent(layered(), homogeneous(), 12e-6, false).verdict, EstimateVerdict::kInconsistent);
}

TEST(RivalWatch, TheRightCellIsNot) {
  EXPECT_EQ(indent(layered(), layered(), 12e-6, true).verdict, EstimateVerdict::kConverged);
  EXPECT_EQ(indent(homogeneous(), homogeneous(), 12e-6, true).verdict, EstimateVerdict::kConverged);
}

TEST(RivalWatch, BesideTheAxisNothingIsCompared) {
  const Scene truth = layered();
  const CellEstimate found = indent(truth, homogeneous(), 6e-6, true, 0.2 * truth.radius());
  EXPECT_EQ(found.reason.find("another cell"), std::string::npos) << found.reason;
}

}  // namespace
}  // namespace microinjection
