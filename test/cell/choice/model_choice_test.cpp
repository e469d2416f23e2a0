#include "cell/choice/model_choice.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace microinjection {
namespace {

TEST(ModelChoice, TakesTheCheapestThatMeetsBothRequirements) {
  const ModelFigures coarse{"coarse", 0.5, 1e-6}, good{"good", 0.01, 1e-4}, best{"best", 0.001, 5e-4},
      slow{"slow", 1e-4, 0.1};
  const auto chosen = [&](double error, double rate) { return chooseModel({error, rate}, {slow, best, coarse, good}); };
  EXPECT_EQ(chosen(0.02, 1000).name, "good");
  EXPECT_EQ(chosen(0.6, 1000).name, "coarse");
  EXPECT_EQ(chosen(0.002, 1000).name, "best");
  EXPECT_EQ(chosen(0.0005, 5).name, "slow");
  EXPECT_TRUE(chosen(0.02, 1000).meets);
  EXPECT_NE(chosen(0.02, 1000).reason.find("slow"), std::string::npos);  // the figures of all are told
}

TEST(ModelChoice, SaysWhenNoneMeetsThem) {
  const ModelFigures live{"live", 1.1, 0.05}, prepared{"surrogate", 0.03, 2e-6};
  const ModelChoice inexact = chooseModel({0.001, 1000}, {live, prepared});
  EXPECT_EQ(inexact.name, "surrogate");  // quick enough, and nearest
  EXPECT_FALSE(inexact.meets);
  EXPECT_NE(inexact.reason.find("NO model"), std::string::npos);
  EXPECT_EQ(chooseModel({0.02, 1e7}, {live, prepared}).name, "surrogate");  // none is quick enough: the quickest
  EXPECT_FALSE(chooseModel({0.02, 1000}, {live}).meets);
}

/// Figures belong to the live cell that they were measured of; the surrogate data of all these scenes are the same.
TEST(ModelChoice, FiguresAreThoseOfTheLiveCell) {
  const std::string cache = testing::TempDir() + "model_choice_cache";
  std::filesystem::remove_all(cache);
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  Scene scene;
  scene.mesh.size = 12.0e-6;
  saveFigures(scene, {"live", 0.5, 0.02});
  const auto loaded = loadFigures(scene, "live");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded.content->force_error, 0.5);
  EXPECT_EQ(loaded.content->time, 0.02);
  std::vector<Scene> others(5, scene);
  others[0].mesh.size = 12.3e-6;
  others[1].mesh.stretch = 2;
  others[2].mesh.refinement.density *= 1.01;
  others[3].mesh.refinement.zone *= 1.01;
  others[4].cell.material().viscoelasticity.prony = {{0.5, 0.2}};  // of other elements
  const SurrogateRange range = SurrogateRange::standard(scene);
  for (const Scene& other : others) {
    EXPECT_FALSE(loadFigures(other, "live"));
    EXPECT_EQ(surrogateFile(scene, SurrogatePlan::plan(scene, range)),
              surrogateFile(other, SurrogatePlan::plan(other, range)));
  }
  saveFigures(others[4], {"live", 0.02, 0.1});
  EXPECT_EQ(loadFigures(scene, "live").content->force_error, 0.5);
}

/// Under a rounded tip the live cell does not lock: some per cent, but no force in a millisecond.
TEST(ModelChoice, MeasuresTheLiveCellOfARoundedTip) {
  Scene scene;
  scene.needle.tip.shape = "hemisphere";
  scene.cell.material() = {"neo_hookean", 17.9e3, 0.49};
  const ModelFigures live = measureLiveCell(scene);
  EXPECT_EQ(live.name, "live");
  EXPECT_GT(live.force_error, 0.005);
  EXPECT_LT(live.force_error, 0.1);
  EXPECT_GT(live.time, 0.001);
}

}  // namespace
}  // namespace microinjection
