#include "trial/hand_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

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

/// Trials of which each has a fault, found by its kind.
HandTrial faulty(const std::string& kind) {
  for (int seed = 1; seed < 200; ++seed) {
    HandTrial::Config config;
    config.seed = seed;
    config.noise = 0;
    config.faults = 1;
    HandTrial of(cell(), config);
    if (toText(of.fault().kind) == kind) return of;
  }
  throw std::invalid_argument(kind);
}

/// The same cell, where nothing fails.
HandTrial healthy(const HandTrial& of) { return trial(of.seed(), 0, 0); }

void stepBoth(HandTrial& of, HandTrial& other, double until, const Eigen::Vector3d& velocity = kDown) {
  while (valueOf(of, "time_s") < until) {
    for (HandTrial* each : {&of, &other}) each->step(velocity, false, 1);
  }
}

TEST(HandTrial, AShareOfTheTrialsHasAFaultOfEachKind) {
  std::map<std::string, int> found;
  for (int seed = 1; seed <= 600; ++seed) {
    const InjectionCase of = randomInjectionCase(seed);
    const auto fault = randomFault(of, 0.5);
    ++found[toText(fault.kind)];
    EXPECT_EQ(toText(randomFault(of, 0).kind), "");
    if (fault.kind != InjectionRig::Disturbance::Kind::kNone) {
      EXPECT_EQ(randomFault(of, 1).kind, fault.kind);
      EXPECT_TRUE(fault.begin >= 0.5 && fault.begin <= 8);
    }
  }
  EXPECT_NEAR(found[""], 300, 50);
  for (const char* kind :
       {"sensor_frozen", "sensor_offset", "sensor_drift", "commands_lost", "commands_late", "needle_drift"})
    EXPECT_NEAR(found[kind], 50, 25) << kind;
}

TEST(HandTrial, NothingFailsBeforeItsTime) {
  HandTrial of = faulty("sensor_offset"), other = healthy(of);
  stepBoth(of, other, of.fault().begin - 2e-3);
  EXPECT_EQ(of.observation(), other.observation());
}

TEST(HandTrial, AFaultySensorReadsWhatIsNotThere) {
  for (const auto& [kind, after] : {std::pair("sensor_offset", 0.01), std::pair("sensor_drift", 0.5)}) {
    HandTrial of = faulty(kind), other = healthy(of);
    stepBoth(of, other, of.fault().begin + after, kUp);
    const double off = valueOf(of, "force_axial_N") - valueOf(other, "force_axial_N");
    EXPECT_NEAR(off / of.fault().size, kind == std::string("sensor_drift") ? after : 1, 0.1) << kind;
  }
  HandTrial frozen = faulty("sensor_frozen"), other = healthy(frozen);
  stepBoth(frozen, other, frozen.fault().begin + 3);
  const double reading = valueOf(frozen, "force_axial_N");
  frozen.step(kDown, false, 100);
  EXPECT_EQ(valueOf(frozen, "force_axial_N"), reading);
}

TEST(HandTrial, FaultyCommandsMoveTheNeedleLater) {
  const Eigen::Vector3d slow = 0.1 * kUp;  // a faster one is held, as it lags too far
  std::map<std::string, double> behind;
  for (const char* kind : {"commands_lost", "commands_late"}) {
    HandTrial of = faulty(kind), other = healthy(of);
    stepBoth(of, other, of.fault().begin + 0.5, slow);
    behind[kind] = (valueOf(other, "z_m") - valueOf(of, "z_m")) / slow.z() - of.fault().size;
  }
  EXPECT_NEAR(behind["commands_lost"], 0.5, 0.05);
  EXPECT_GT(behind["commands_late"], -0.01);
  EXPECT_LT(behind["commands_late"], 0.2);
}

TEST(HandTrial, ADriftingNeedleIsWhereTheDeviceDoesNotTell) {
  HandTrial of = faulty("needle_drift"), other = healthy(of);
  stepBoth(of, other, of.fault().begin + 1, kUp);
  EXPECT_NEAR(valueOf(of, "z_m"), valueOf(other, "z_m"), 1e-7);
  EXPECT_NEAR(of.trueTip().z() - other.trueTip().z(), of.fault().size, 1e-7);
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
  HandTrial::Config config;
  config.faults = 1.1;
  EXPECT_THROW(HandTrial(cell(), config), ConfigError);
}

}  // namespace
}  // namespace microinjection
