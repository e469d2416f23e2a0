#include "cell/surrogate/training_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cell/surrogate/spring_cells.h"

namespace microinjection {
namespace {

/// Results of a plan whose paths all reach their targets.
std::vector<TrainingResult> completeResults(const SurrogatePlan& plan) {
  std::vector<TrainingResult> results;
  for (const TrainingRay& ray : plan.rays) {
    TrainingSample sample;
    sample.displacement = ray.target;
    results.push_back({{sample}, ""});
  }
  return results;
}

void endAt(double share, const TrainingRay& ray, TrainingResult& result) {
  result.samples.front().displacement = share * ray.target;
  result.reason = "no stable equilibrium";
}

class ReachedRange : public testing::Test {
 protected:
  const Scene scene_ = pipette();
  const SurrogatePlan plan_ = SurrogatePlan::plan(scene_, SurrogateRange::standard(scene_));
  std::vector<TrainingResult> results_ = completeResults(plan_);
};

TEST_F(ReachedRange, IsThatOfThePlanWhenEveryPathIsComplete) {
  const SurrogateRange range = reachedRange(plan_, results_);
  EXPECT_EQ(range.depth, plan_.range.depth);
  EXPECT_EQ(range.lateral, plan_.range.lateral);
}

TEST_F(ReachedRange, ShrinksToThePathThatEndedFirst) {
  std::size_t ended = 0;
  for (std::size_t i = 0; i < plan_.rays.size(); ++i) {
    if (plan_.rays[i].level != kCoarseLevel) endAt(0.1, plan_.rays[i], results_[i]);  // the coarse mesh goes on
    if (plan_.rays[i].level == kCoarseLevel && ended < 2) endAt(0.6 - 0.1 * ended++, plan_.rays[i], results_[i]);
  }
  ASSERT_EQ(ended, 2u);
  const SurrogateRange range = reachedRange(plan_, results_);
  EXPECT_NEAR(range.depth, 0.5 * plan_.range.depth, 1e-12 * plan_.range.depth);
  EXPECT_NEAR(range.lateral, 0.5 * plan_.range.lateral, 1e-12 * plan_.range.lateral);
  EXPECT_EQ(range.angle, plan_.range.angle);
}

/// Also where the path in space ended early, since the section may go on.
TEST_F(ReachedRange, TheAxisIsSampledWithoutAGap) {
  const auto straight = std::find_if(plan_.rays.begin(), plan_.rays.end(), [](const TrainingRay& ray) {
    return ray.angle == 0 && ray.target.head<2>().isZero(0);
  });
  ASSERT_NE(straight, plan_.rays.end());
  const std::vector<double> depths = axisDepths(plan_.range, *straight);
  EXPECT_LT(depths.front(), 0.01 * plan_.range.depth);
  for (std::size_t i = 1; i < depths.size(); ++i) {
    EXPECT_GT(depths[i], depths[i - 1]);
    EXPECT_LT(depths[i], depths[i - 1] + 0.2 * plan_.range.depth);
  }
  EXPECT_NEAR(depths.back(), plan_.range.axis_depth, 1e-12 * plan_.range.axis_depth);
}

TEST_F(ReachedRange, IsRefusedWhenHardlyAnythingIsLeft) {
  endAt(0.1, plan_.rays.back(), results_.back());
  EXPECT_THROW(reachedRange(plan_, results_), std::runtime_error);
  results_.back().samples.clear();
  EXPECT_THROW(reachedRange(plan_, results_), std::runtime_error);
}

}  // namespace
}  // namespace microinjection
