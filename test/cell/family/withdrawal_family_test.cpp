#include "cell/family/withdrawal_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr char kShipped[] = MICROINJECTION_SOURCE_DIR "/config/families";

Scene adhering(double friction, double energy) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml");
  scene.needle.contact = {friction > 0 ? "sliding" : "sticking", friction, energy, energy > 0 ? 0.2e-6 : 0};
  return scene;
}

/// Of a turn that no member has, in cells that no member is, on a finer mesh than theirs.
TEST(Withdrawal, OfAFamilyIsThatOfASolution) {
  for (const Scene& scene : {adhering(0.15, 6e-4), adhering(0.12, 0)}) {
    std::string reason;
    const auto loss = findWithdrawal(kShipped, scene, reason);
    ASSERT_TRUE(loss) << reason;
    EXPECT_LT(loss->error(), 0.03);
    CellProblem<2> problem(scene, makeSceneMesh<2>(scene, 1), ElementKind::kP2P0);
    const auto force = [&](double depth) {
      const IndentationSolution solution = problem.solve({0, 0, -depth});
      EXPECT_TRUE(solution.converged) << depth << ": " << solution.reason;
      return solution.force.z();
    };
    const double turn = 0.28 * scene.radius();
    std::vector<double> depths, in;
    for (int i = 0; i <= 16; ++i) {
      depths.push_back(turn * i / 16);
      in.push_back(force(depths.back()));
    }
    double largest = 0;
    for (int i = 16; i >= 0; --i) {
      const double lost = (in[i] - force(depths[i])) / in.back();
      EXPECT_NEAR(loss->share(depths[i], turn), lost, 0.005) << scene.needle.contact.friction << ' ' << i;
      largest = std::max(largest, lost);
    }
    EXPECT_GT(largest, 0.01);
    if (scene.needle.contact.adhesion_energy == 0) continue;
    double pull = 0;
    for (double depth = 0; depth > -1e-6; depth -= 0.05e-6) pull = std::max(pull, -force(depth) / in.back());
    double served = 0;
    for (double depth = 0; depth > -1e-6; depth -= 0.05e-6) served = std::max(served, loss->share(depth, turn));
    EXPECT_NEAR(served, pull, 0.05 * pull);
  }
}

TEST(Withdrawal, OfATipThatSticksIsThatOfTheLargestFriction) {
  std::string reason;
  const double turn = 9e-6;
  const auto sticks = findWithdrawal(kShipped, adhering(0, 6e-4), reason);
  const auto rubs = findWithdrawal(kShipped, adhering(3, 6e-4), reason);
  ASSERT_TRUE(sticks && rubs) << reason;
  for (const double depth : {-0.2e-6, 0.0, 3e-6}) EXPECT_EQ(sticks->share(depth, turn), rubs->share(depth, turn));
  EXPECT_GT(sticks->share(-0.2e-6, turn), 0);
}

TEST(Withdrawal, OfAnotherCellIsRefused) {
  const auto reasonOf = [](const Scene& scene) {
    std::string reason;
    EXPECT_FALSE(findWithdrawal(kShipped, scene, reason));
    return reason;
  };
  EXPECT_NE(reasonOf(adhering(0.15, 1)).find("adhesion_root = "), std::string::npos) << reasonOf(adhering(0.15, 1));
  EXPECT_NE(reasonOf(adhering(0.05, 0)).find("friction = 0.05: must be from 0.1 to 0.5"), std::string::npos);
  Scene slides = adhering(0.15, 6e-4);
  slides.needle.contact.friction = 0;
  EXPECT_NE(reasonOf(slides).find("slides without friction"), std::string::npos) << reasonOf(slides);
}

}  // namespace
}  // namespace microinjection
