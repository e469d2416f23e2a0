// The cell estimator learns from no reading that it cannot trust, says why, and has nothing served that it has not
// learned.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cell_microinjection/CellEstimate.h"
#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/InjectionStatus.h"
#include "scripted_needle.h"

namespace microinjection {
namespace {

constexpr double kSurface = 28e-6;        // m
constexpr double kPriorModulus = 17.9e3;  // Pa
constexpr char kSensor[] = "force_sensor/measured_cf", kInjection[] = "controller/injection_state";

/// The test is the needle, the sensor and the controller.
class CellEstimatorTrustTest : public testing::Test {
 protected:
  CellEstimatorTrustTest() {
    session_.world().hear<cell_microinjection::CellEstimate>("cell/estimate");
    changes();
    session_.add("cell_estimator", "{serve: true, diagnostic_period: 0.1}");
    begin();
  }

  /// All is well, and the needle is clear of the cell.
  void begin() {
    punctures_ = 0;
    needle_.publish();
    publishForce();
    publishInjection();
    needle_.jumpTo(kSurface + 20e-6, 0.2);
    EXPECT_EQ(estimate().held, "");
  }
  /// A needle that goes down at 20 um/s.
  void lowerTo(double height) { needle_.moveTo(height, 20e-6); }
  /// No two readings of a sensor are the same.
  void publishForce() {
    session_.world().repeat<geometry_msgs::WrenchStamped>(kSensor, [this] {
      const double depth = std::max(0.0, kSurface - needle_.z);
      const double noise = 1e-10 * std::sin(1e4 * session_.now().toSec());
      return std::optional(wrenchMessage(0, 0, force_at_(depth) + noise, "needle_tip"));
    });
  }
  void publishForce(const geometry_msgs::WrenchStamped& message) { session_.world().repeat(kSensor, message); }
  void publishInjection() {
    session_.world().repeat<cell_microinjection::InjectionStatus>(kInjection, [this] {
      cell_microinjection::InjectionStatus status;
      status.state = "indent";
      status.punctures = punctures_;
      return std::optional(status);
    });
  }
  const cell_microinjection::CellEstimate& estimate() {
    return *session_.world().hear<cell_microinjection::CellEstimate>("cell/estimate").newest();
  }
  Probe<cell_microinjection::CellParameters>& changes() {
    return session_.world().hear<cell_microinjection::CellParameters>("cell/set_parameters");
  }
  void expectHeld(const std::string& reason) {
    EXPECT_NE(estimate().held.find(reason), std::string::npos) << estimate().held;
  }

  VirtualSession session_{{"cell:=mouse_oocyte_pipette", "estimator:=true"}};
  ScriptedNeedle needle_{session_, kSurface + 20e-6};
  unsigned punctures_ = 0;
  std::function<double(double)> force_at_ = [](double depth) { return 0.05 * depth; };  ///< N, of a depth (m)
};

TEST_F(CellEstimatorTrustTest, LearnsNothingFromWhatItCannotTrust) {
  geometry_msgs::PoseStamped tilted = poseMessage(0, 0, kSurface - 1e-6);
  tilted.pose.orientation.x = std::sin(0.05);
  tilted.pose.orientation.w = std::cos(0.05);
  const auto needle = [&](const geometry_msgs::PoseStamped& message) {
    return [&, message] { needle_.publish(message); };
  };
  const auto force = [&](double z, const char* frame) {
    return [this, z, frame] { publishForce(wrenchMessage(0, 0, z, frame)); };
  };
  const std::pair<std::function<void()>, std::string> cases[] = {
      {[&] { needle_.publishInvalid(); }, "no valid needle pose"},
      {needle(poseMessage(0, 0, NAN)), "no valid needle pose"},
      {needle(poseMessage(0, 0, kSurface, "camera")), "no valid needle pose"},
      {needle(tilted), "the needle is tilted"},
      {[&] { session_.world().repeatInvalid<geometry_msgs::WrenchStamped>(kSensor); }, "no valid force"},
      {force(INFINITY, "needle_tip"), "no valid force"},
      {force(1e-6, "camera"), "no valid force"},
      {force(480e-6, "needle_tip"), "saturated"}};
  int number = 0;
  for (const auto& [make_bad, reason] : cases) {
    SCOPED_TRACE(std::to_string(++number) + ": " + reason);
    begin();
    changes().clear();
    make_bad();
    needle_.jumpTo(kSurface + 1e-6, 0.06);
    const auto before = estimate().samples;
    lowerTo(kSurface - 3e-6);
    expectHeld(reason);
    EXPECT_EQ(estimate().samples, before);
    EXPECT_EQ(estimate().verdict, "prior");
    EXPECT_EQ(changes().count(), 0U);
  }
}

TEST_F(CellEstimatorTrustTest, LearnsNothingOnceAMessageIsOld) {
  const std::pair<const char*, const char*> cases[] = {
      {"needle/measured_cp", "needle pose"}, {kSensor, "no valid force"}, {kInjection, "nobody knows of a puncture"}};
  for (const auto& [topic, reason] : cases) {
    begin();
    session_.world().silence(topic);
    session_.run(0.7);
    expectHeld(reason);
  }
}

TEST_F(CellEstimatorTrustTest, APunctureEndsTheLessonUntilTheNeedleIsClear) {
  lowerTo(kSurface - 3e-6);
  EXPECT_EQ(estimate().held, "");
  const auto learned = estimate().samples;
  EXPECT_GT(learned, 10U);
  punctures_ = 1;
  lowerTo(kSurface - 5e-6);
  expectHeld("punctured");
  EXPECT_LE(estimate().samples, learned + 1);
  needle_.jumpTo(kSurface + 20e-6, 0.1);  // the count stays until the needle starts anew
  EXPECT_EQ(estimate().held, "");
  EXPECT_EQ(estimate().verdict, "prior");
  lowerTo(kSurface - 3e-6);
  EXPECT_GT(estimate().samples, 10U);
}

/// What is touched gives way.
TEST_F(CellEstimatorTrustTest, AForceOfNoSuchCellIsInconsistentAndThePriorIsServed) {
  force_at_ = [](double depth) {
    return 0.05 * std::min(depth, 4e-6 - 0.5 * std::min(depth, 4e-6)) + 1e-9 * std::sin(1e9 * depth);
  };
  needle_.z = kSurface + 1e-6;
  lowerTo(kSurface - 8e-6);
  EXPECT_EQ(estimate().verdict, "inconsistent");
  EXPECT_EQ(estimate().modulus, kPriorModulus);
  session_.run(3);
  EXPECT_NEAR(estimate().served_modulus / kPriorModulus, 1, 0.01);
  const auto* status = session_.diagnostics().of("cell_estimator: cell under the needle");
  ASSERT_NE(status, nullptr);
  EXPECT_NE(status->level, 0);
  EXPECT_NE(status->message.find("inconsistent"), std::string::npos) << status->message;
}

}  // namespace
}  // namespace microinjection
