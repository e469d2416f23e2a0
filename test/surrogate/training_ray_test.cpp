#include "surrogate/training_ray.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

Scene pipette() { return loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml"); }

/// In the plane of symmetry half of the mesh is solved; a picometre beside it all of it.
TEST(TrainingRay, HalfOfTheMeshGivesForceAndSurfaceOfTheWhole) {
  const Scene scene = pipette();
  TrainingRay ray{0.7, {0.3e-6, 0, -1.2e-6}, 1};
  const TrainingSample half = solveRay(scene, ray).samples.at(0);
  ray.target.y() = 1e-12;
  const TrainingSample whole = solveRay(scene, ray).samples.at(0);
  EXPECT_EQ(half.force.y(), 0);
  EXPECT_LT((half.force - whole.force).norm(), 0.02 * whole.force.norm());  // the whole mesh is not quite symmetric
  EXPECT_GT(half.force.norm(), 1e-8);
  ASSERT_EQ(half.surface.size(), whole.surface.size());
  EXPECT_LT((half.surface - whole.surface).norm(), 0.05 * whole.surface.norm());
}

TEST(TrainingRay, SamplesAreReadAsTheyWereWritten) {
  TrainingResult result;
  result.reason = "ended";
  result.samples.push_back({0.3, {1, 2, 3}, {4, 5, 6}, Eigen::VectorXf::LinSpaced(6, 0, 1)});
  const TrainingResult read = decodeTraining(encode(result));
  EXPECT_EQ(read.reason, result.reason);
  ASSERT_EQ(read.samples.size(), 1u);
  EXPECT_EQ(read.samples[0].angle, 0.3);
  EXPECT_EQ(read.samples[0].displacement, result.samples[0].displacement);
  EXPECT_EQ(read.samples[0].force, result.samples[0].force);
  EXPECT_EQ(read.samples[0].surface, result.samples[0].surface);
}

}  // namespace
}  // namespace microinjection
