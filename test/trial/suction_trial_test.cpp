#include "trial/suction_trial.h"

#include <gtest/gtest.h>

#include "cell/family/family_cell.h"

namespace microinjection {
namespace {

constexpr char kFolder[] = MICROINJECTION_SOURCE_DIR;

TrialCell oocyte() {
  const Scene scene = loadScene(std::string(kFolder) + "/config/cells/mouse_oocyte_pipette.yaml");
  std::string reason;
  const auto member = findFamilyCell(std::string(kFolder) + "/config/families", scene, reason);
  if (!member) throw std::runtime_error(reason);
  return TrialCell{scene, member->data, std::string(kFolder) + "/urdf/rig.urdf"};
}

/// A tongue as that of a half space under small suctions, up to its end.
BoreTongue halfSpace() {
  std::vector<BoreTongue::Point> points;
  for (int i = 0; i <= 7; ++i) points.push_back({0.05 * i, 0.05 * i, 0.1 * i});
  return BoreTongue(points);
}

/// With the force, with images and with both: each break is told and confirmed, the suction ends in time, and a
/// membrane that withstands it is not taken for broken.
TEST(SuctionTrial, EachWitnessTellsTheBreak) {
  using Witnesses = SuctionTrial::Witnesses;
  const TrialCell cell = oocyte();
  const BoreTongue tongue = halfSpace();
  int broken = 0;
  for (const Witnesses witnesses : {Witnesses::kBoth, Witnesses::kForce, Witnesses::kImage}) {
    for (const int seed : {0, 1, 2, 9}) {
      const SuctionTrial trial = SuctionTrial::run(cell, tongue, seed, witnesses);
      SCOPED_TRACE(std::to_string(seed) + ", " + std::to_string(static_cast<int>(witnesses)));
      EXPECT_EQ(trial.truth.punctures, trial.result.punctures) << trial.result.reason;
      EXPECT_TRUE(trial.breaks || trial.result.break_suction == 0);
      EXPECT_EQ(trial.truth.false_detections, 0);
      if (!trial.truth.broken_by_suction) continue;
      ++broken;
      ASSERT_TRUE(trial.truth.suction_latency);
      EXPECT_LT(*trial.truth.suction_latency, 0.1);
      EXPECT_GT(trial.truth.drawn_too_much, 0);
      EXPECT_LT(trial.truth.drawn_too_much, 1e-15);
      EXPECT_EQ(trial.result.outcome, InjectionOutcome::kPunctured);
    }
  }
  EXPECT_EQ(broken, 9);
}

}  // namespace
}  // namespace microinjection
