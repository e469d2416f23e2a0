#include "cell/surrogate/training_ray.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cell/surrogate/surface_grid.h"

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

/// A path of two places.
struct StoredPath {
  TrainingRay ray{0.3, {4e-6, 0, -8e-6}, 2};
  TrainingResult result;
  std::string path = testing::TempDir() + "microinjection_path";

  StoredPath() {
    for (const double share : {0.25, 1.0}) {
      result.samples.push_back({ray.angle,
                                share * ray.target,
                                {1, 2, 3},
                                Eigen::VectorXf::LinSpaced(3 * SurfaceGrid::standard().nodeCount(), 0, 1)});
    }
  }
  CacheRead<TrainingResult> loadOf(const std::string& bytes) const {
    writeCacheFile(path, "path", bytes);
    return loadTraining(path, "path", ray);
  }
};

TEST(TrainingRay, AStoredPathIsLoaded) {
  StoredPath stored;
  const auto whole = stored.loadOf(encode(stored.result));
  ASSERT_TRUE(whole) << whole.reason;
  EXPECT_EQ(whole.content->samples.size(), 2u);
  stored.result.samples.pop_back();
  stored.result.reason = "ended";
  EXPECT_TRUE(stored.loadOf(encode(stored.result)));
  EXPECT_EQ(loadTraining(stored.path, "other path", stored.ray).state, CacheState::kOther);
}

/// The fit would take it for a force, or read beyond a surface that is too short.
TEST(TrainingRay, AStoredPathThatCannotBeIsDamagedWhateverItsChecksum) {
  const StoredPath stored;
  const std::string bytes = encode(stored.result);
  const auto with = [&](auto change) {
    TrainingResult result = stored.result;
    change(result);
    return encode(result);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::pair<const char*, std::string>> cases = {
      {"empty", ""},
      {"short", bytes.substr(0, bytes.size() - 1)},
      {"long", bytes + "x"},
      {"no number", with([](TrainingResult& r) { r.samples[1].force.y() = kNan; })},
      {"no surface's number", with([](TrainingResult& r) { r.samples[1].surface[4] = kNan; })},
      {"too few", with([](TrainingResult& r) { r.samples.pop_back(); })},
      {"too many", with([](TrainingResult& r) { r.samples.push_back(r.samples.back()); })},
      {"another path", with([](TrainingResult& r) { r.samples[0].displacement *= 2; })},
      {"another angle", with([](TrainingResult& r) { r.samples[0].angle = 0; })},
      {"another grid", with([](TrainingResult& r) { r.samples[1].surface.conservativeResize(6); })}};
  for (const auto& [what, body] : cases) {
    const auto read = stored.loadOf(body);
    EXPECT_FALSE(read) << what;
    EXPECT_EQ(read.state, CacheState::kDamaged) << what;
    EXPECT_EQ(read.reason.find(stored.path + ": is damaged: "), 0u) << what << ": " << read.reason;
  }
}

}  // namespace
}  // namespace microinjection
