#include "trial/hand_trial.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.h"
#include "cell/family/family_cell.h"

namespace microinjection {
namespace {

constexpr char kSource[] = MICROINJECTION_SOURCE_DIR;

const TrialCell& cell() {
  static const TrialCell all = [] {
    const Scene scene = loadScene(std::string(kSource) + "/config/cells/mouse_oocyte_pipette.yaml");
    std::string reason;
    const auto member = findFamilyCell(std::string(kSource) + "/config/families", scene, reason);
    if (!member) throw std::runtime_error(reason);
    return TrialCell{scene, member->data, std::string(kSource) + "/urdf/rig.urdf"};
  }();
  return all;
}

HandTrial trial(int seed, double delay = 0, double noise = 1) {
  HandTrial::Config config;
  config.seed = seed;
  config.force_delay = delay;
  config.noise = noise;
  return HandTrial(cell(), config);
}

double valueOf(const HandTrial& trial, const std::string& name) {
  for (std::size_t i = 0; i < HandTrial::kObservation.size(); ++i) {
    if (HandTrial::kObservation[i] == name) return trial.observation()[static_cast<Eigen::Index>(i)];
  }
  throw std::invalid_argument(name);
}

const Eigen::Vector3d kDown(0, 0, -10e-6), kUp(0, 0, 100e-6);

/// Down until something has given way, or for `limit` s.
void indent(HandTrial& of, double limit = 60) {
  while (valueOf(of, "punctures") < 1 && valueOf(of, "time_s") < limit && !of.over()) of.step(kDown, false, 10);
}

TEST(HandTrial, AnInjectionByHandIsComplete) {
  HandTrial of = trial(5);
  indent(of);
  ASSERT_EQ(of.state(), "punctured");
  of.step(Eigen::Vector3d::Zero(), true, 1500);
  EXPECT_EQ(of.notice(), "");
  while (!of.over()) of.step(kUp, false, 10);
  const TrainingScore score = of.score();
  EXPECT_EQ(score.outcome, TrainingOutcome::kComplete) << score.reason;
  EXPECT_EQ(score.punctures, 1);
  EXPECT_NEAR(score.volume / of.task().volume, 1, 0.1) << "the whole pulse";
  EXPECT_GT(score.score(), 50);
  EXPECT_THROW(of.step(kUp, false, 1), ConfigError);
}

TEST(HandTrial, APulseBeforeAMembraneIsRefused) {
  HandTrial of = trial(5);
  of.step(kDown, true, 100);
  EXPECT_NE(of.notice(), "");
  EXPECT_LT(valueOf(of, "volume_m3"), 1e-15);
}

TEST(HandTrial, TheSameStepsGiveTheSameBits) {
  HandTrial first = trial(8), again = trial(8), other = trial(9);
  for (HandTrial* of : {&first, &again, &other}) of->step(kDown, false, 2000);
  EXPECT_EQ(first.observation(), again.observation());
  EXPECT_NE(first.observation(), other.observation());
}

/// A reading is that of `delay` before; without noise and drift nothing else differs.
TEST(HandTrial, TheForceComesLateByTheDelay) {
  HandTrial now = trial(5, 0, 0), late = trial(5, 0.05, 0);
  std::vector<double> forces, delayed;
  for (int i = 0; i < 4000; ++i) {
    now.step(kDown, false, 1);
    late.step(kDown, false, 1);
    forces.push_back(valueOf(now, "force_axial_N"));
    delayed.push_back(valueOf(late, "force_axial_N"));
  }
  ASSERT_GT(*std::max_element(forces.begin(), forces.end()), 1e-8);
  for (std::size_t i = 50; i < forces.size(); ++i) ASSERT_EQ(delayed[i], forces[i - 50]) << i;
}

TEST(HandTrial, TheGuardHoldsTheNeedle) {
  HandTrial of = trial(5);
  for (int i = 0; i < 3000 && !of.over(); ++i) of.step(kDown, false, 10);
  EXPECT_LT(valueOf(of, "depth_m"), 1.05 * valueOf(of, "depth_limit_m"));
}

TEST(HandTrial, RefusesWhatIsNoMotion) {
  HandTrial of = trial(1);
  EXPECT_THROW(of.step({0, 0, NAN}, false, 1), ConfigError);
  EXPECT_THROW(of.step({0, 1e-3, 0}, false, 1), ConfigError);
  EXPECT_THROW(of.step(kDown, false, 0), ConfigError);
  EXPECT_THROW(trial(1, -1), ConfigError);
  EXPECT_THROW(trial(1, 0, NAN), ConfigError);
}

}  // namespace
}  // namespace microinjection
