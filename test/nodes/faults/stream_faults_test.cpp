// Every measured stream by which the needle moves, with every fault of its source: by hand and by itself.

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <random>

#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/InjectionPulse.h"
#include "fault_session.h"
#include "led_hand.h"

namespace microinjection {
namespace {

enum class Stream { kMeasured, kPredicted, kNeedle, kHand };
enum class StreamFault { kStops, kRepeats, kRepeatsOld, kNotFinite, kForeignFrame, kSecondSender, kLate, kJump, kZero };

struct FaultyStream {
  Stream stream;
  StreamFault fault;
  bool by_hand;
};

const char* nameOf(Stream stream) {
  static const char* const names[] = {"Measured", "Predicted", "Needle", "Hand"};
  return names[static_cast<int>(stream)];
}
const char* nameOf(StreamFault fault) {
  static const char* const names[] = {"Stops",        "Repeats",           "RepeatsOld", "NotFinite", "ForeignFrame",
                                      "SecondSender", "LateByHalfASecond", "Jumps",      "IsZero"};
  return names[static_cast<int>(fault)];
}
std::string nameOf(const FaultyStream& of) {
  return std::string(nameOf(of.stream)) + nameOf(of.fault) + (of.by_hand ? "ByHand" : "ByItself");
}
void PrintTo(const FaultyStream& of, std::ostream* out) { *out << nameOf(of); }

/// A cell as a spring that never fails, whose force the test says: as the model predicts it and, with noise, as a
/// sensor measures it.
class SpringCell {
 public:
  static constexpr double kSurface = 28e-6, kStiffness = 0.1;  // m, N/m

  explicit SpringCell(TestNode& node) : node_(node), needle_(node.hear<geometry_msgs::PoseStamped>("needle/true_cp")) {
    node.repeat<geometry_msgs::WrenchStamped>(
        "cell/predicted_cf", [this] { return std::optional(wrenchMessage(0, 0, kStiffness * indentation())); });
    node.repeat<geometry_msgs::WrenchStamped>("force_sensor/measured_cf", [this] {
      const double noise = 10e-9 * (random_() / 2147483647.0 - 1);  // N
      return std::optional(wrenchMessage(0, 0, kStiffness * indentation() + noise, "needle_tip"));
    });
    node.repeat<cell_microinjection::CellContact>("cell/contact", [this] {
      cell_microinjection::CellContact contact;
      contact.in_contact = indentation() > 0;
      contact.can_be_punctured = true;
      return std::optional(contact);
    });
  }
  double indentation() const {
    const auto* needle = needle_.newest();
    return needle ? std::max(0.0, kSurface - needle->pose.position.z) : 0;
  }

 private:
  TestNode& node_;
  Probe<geometry_msgs::PoseStamped>& needle_;
  std::mt19937 random_{1};
};

class StreamFaultsTest : public testing::TestWithParam<FaultyStream> {
 protected:
  static constexpr double kSpeed = 20e-6;                  // m/s, of the needle in the cell
  static constexpr double kStart = 32e-6;                  // m
  static constexpr double kDepth = 6e-6, kWay = 5e-6;      // m, where the fault comes, and the way of the hand there
  static constexpr double kAllowed = 1e-6 + 0.2 * kSpeed;  // m, of the needle after the fault
  static constexpr double kKnown = 0.5;                    // s after the fault, by which the needle rests for good

  StreamFaultsTest() {
    session_.world().hear<cell_microinjection::InjectionPulse>("injector/pulse");
    session_.world().hear<geometry_msgs::PoseStamped>("needle/true_cp");
    session_.world().hear<cell_microinjection::InjectionStatus>("controller/injection_state");
    session_.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf");
    for (const char* node : {"micromanipulator", "injection_controller", "haptic_bridge"}) {
      if (GetParam().by_hand || std::string(node) != "haptic_bridge") session_.add(node, "{diagnostic_period: 0.05}");
    }
  }

  static std::vector<std::string> overrides() {
    const std::string source = GetParam().stream == Stream::kMeasured ? "measured" : "predicted";
    std::vector<std::string> all = {
        "cell:=" + testFile("scenes/coarse_oocyte.yaml"), "display.markers:=false", "force.controller:=" + source,
        "overrides:={rig: {start_height: 32e-6}, injection_controller: {detection: {noise_samples: 50}, "
        "goal: {depth: 40e-6, pulse: {duration: 1.0}}, "
        "motion: {stab_speed: 20e-6, indent_speed: 20e-6, approach_speed: 40e-6}}}"};
    for (const char* key : {"hand.device:=external", "hand.require_operator:=false"}) {
      if (GetParam().by_hand) all.emplace_back(key);
    }
    if (!GetParam().by_hand) all.emplace_back("hand.device:=none");
    return all;
  }

  double needle() {
    return session_.world().hear<geometry_msgs::PoseStamped>("needle/true_cp").newest()->pose.position.z;
  }
  /// The needle goes up and down in the cell, or ever deeper.
  void moveInTheCell() {
    if (!GetParam().by_hand) {
      ASSERT_TRUE(session_.until([&] { return cell_.indentation() > kDepth; }, 5));
      return;
    }
    hand_.emplace(session_);
    session_.run(0.3);
    hand_->moveTo(-(kStart - SpringCell::kSurface + kDepth) / LedHand::kScale, kSpeed / LedHand::kScale, 0);
    hand_->sway(kWay / LedHand::kScale, kSpeed / LedHand::kScale);
    session_.run(0.1);
    ASSERT_GT(cell_.indentation(), kDepth);
  }

  std::string topic() const {
    static const char* const topics[] = {"/force_sensor/measured_cf", "/cell/predicted_cf", "/needle/measured_cp",
                                         "/haptic/measured_cp"};
    return topics[static_cast<int>(GetParam().stream)];
  }
  void strike() {
    const bool is_force = GetParam().stream == Stream::kMeasured || GetParam().stream == Stream::kPredicted;
    is_force ? alter<geometry_msgs::WrenchStamped>(
                   [](auto& message) -> auto& { return message.wrench.force; }, 5e-6)
             : alter<geometry_msgs::PoseStamped>(
                   [](auto& message) -> auto& { return message.pose.position; },
                   GetParam().stream == Stream::kHand ? 20e-3 : 30e-6);
  }
  /// `jump`: m or N.
  template <typename Message, typename Value>
  void alter(Value value, double jump) {
    boost::shared_ptr<const Message> first;
    session_.executive().network().alter(topic(), [=, fault = GetParam().fault](Passage passage) mutable {
      const auto original = boost::static_pointer_cast<const Message>(passage.message);
      const auto message = boost::make_shared<Message>(*original);
      if (!first) first = original;
      passage.message = message;
      const Passage good{passage.sender, original, 0};
      switch (fault) {
        case StreamFault::kStops:
          return std::vector<Passage>{};
        case StreamFault::kRepeats:
          value(*message) = value(const_cast<Message&>(*first));
          break;
        case StreamFault::kRepeatsOld:
          *message = *first;
          break;
        case StreamFault::kNotFinite:
          value(*message).z = NAN;
          break;
        case StreamFault::kForeignFrame:
          message->header.frame_id = "camera";
          break;
        case StreamFault::kSecondSender:
          passage.sender = "/stranger";
          value(*message).z *= 0.8;
          return std::vector<Passage>{good, passage};
        case StreamFault::kLate:
          passage.delay = 0.5;
          break;
        case StreamFault::kJump:
          value(*message).z += jump;
          break;
        case StreamFault::kZero:
          value(*message).x = value(*message).y = value(*message).z = 0;
          break;
      }
      return std::vector<Passage>{passage};
    });
  }

  /// What must be said; empty: nothing is wrong.
  std::string reason() const {
    const StreamFault fault = GetParam().fault;
    if (fault == StreamFault::kSecondSender) return "two nodes";
    if (fault == StreamFault::kRepeats) return " repeats ";
    switch (GetParam().stream) {
      case Stream::kMeasured:
      case Stream::kPredicted:
        return fault == StreamFault::kZero   ? " repeats "
               : fault == StreamFault::kJump ? "allowed is a ratio"
                                             : "no valid force";
      case Stream::kNeedle:
        return fault == StreamFault::kZero || fault == StreamFault::kJump ? "the needle moves at"
                                                                          : "no valid needle position";
      case Stream::kHand:
        return fault == StreamFault::kZero           ? " repeats "
               : fault == StreamFault::kJump         ? "the hand was too fast"
               : fault == StreamFault::kForeignFrame ? ""
                                                     : "no valid hand position";
    }
    return "";
  }
  bool said(const std::string& text) {
    for (const char* name : {"injection_controller: inputs", "injection_controller: control", "haptic_bridge: inputs",
                             "haptic_bridge: loop"}) {
      if (session_.diagnostics().ever(name, text)) return true;
    }
    return false;
  }
  /// A force that leaps within its guards leads no hand, and a hand's frame is that of its driver: the needle goes on
  /// as the hand commands.
  bool goesOn() const {
    const FaultyStream& of = GetParam();
    if (of.stream == Stream::kHand) return of.fault == StreamFault::kJump || of.fault == StreamFault::kForeignFrame;
    return of.by_hand && of.stream != Stream::kNeedle && of.fault == StreamFault::kJump;
  }

  VirtualSession session_{overrides()};
  SpringCell cell_{session_.world()};
  std::optional<LedHand> hand_;
};

TEST_P(StreamFaultsTest, MoveTheNeedleNoFurtherGiveNoPulseAndAreSaid) {
  moveInTheCell();
  if (HasFatalFailure()) return;
  const double struck = session_.now().toSec(), from = needle();
  EXPECT_FALSE(said(reason().empty() ? "no valid" : reason()));
  session_.diagnostics().clear();
  auto& poses = session_.world().hear<geometry_msgs::PoseStamped>("needle/true_cp");
  const std::size_t first = poses.count();
  strike();
  session_.run(2.5);
  double farthest = 0, low = INFINITY, high = -INFINITY, fastest = 0, last = from;
  for (std::size_t i = first; i < poses.count(); ++i) {
    const double z = poses.all()[i]->pose.position.z, since = poses.arrivals()[i].toSec() - struck;
    farthest = std::max(farthest, std::abs(z - from));
    fastest = std::max(fastest, std::abs(z - last) / 1e-3);
    last = z;
    if (since < kKnown) continue;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  if (goesOn()) {
    EXPECT_GT(high - low, 0.8 * kWay);
    EXPECT_LT(high - low, 1.2 * kWay + 1e-6);
    EXPECT_LE(farthest, 2 * kWay + 1e-6);
  } else {
    EXPECT_LE(farthest, kAllowed);
    EXPECT_LT(high - low, 0.05e-6) << "it does not rest";
  }
  EXPECT_EQ(session_.world().hear<cell_microinjection::InjectionPulse>("injector/pulse").count(), 0u);
  if (reason().empty()) return;
  EXPECT_TRUE(said(reason())) << "controller: " << session_.diagnostics().text("injection_controller: control") << "; "
                              << session_.diagnostics().text("injection_controller: inputs")
                              << "\nbridge: " << session_.diagnostics().text("haptic_bridge: loop") << "; "
                              << session_.diagnostics().text("haptic_bridge: inputs");
  const bool force_lives = GetParam().stream == Stream::kNeedle || goesOn();
  if (!GetParam().by_hand || force_lives) return;
  const auto& felt = session_.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf").newest()->wrench.force;
  EXPECT_EQ(toVector(felt).norm(), 0) << "the hand feels a force that nobody knows";
}

/// A Touch whose driver hung for a while: the hand has moved on meanwhile, the needle goes on from where it is.
class HungHandTest : public StreamFaultsTest {};

TEST_P(HungHandTest, LeadsOnFromWhereTheNeedleIs) {
  moveInTheCell();
  if (HasFatalFailure()) return;
  strike();
  session_.run(2.3);
  EXPECT_TRUE(said(" repeats "));
  const double held = needle();
  auto& poses = session_.world().hear<geometry_msgs::PoseStamped>("needle/true_cp");
  const std::size_t first = poses.count();
  session_.executive().network().alter(topic(), {});
  session_.run(0.2);
  EXPECT_LE(std::abs(needle() - held), 1.2 * 0.2 * kSpeed);
  session_.run(0.8);
  double fastest = 0, low = INFINITY, high = -INFINITY;
  for (std::size_t i = first + 1; i < poses.count(); ++i) {
    const double z = poses.all()[i]->pose.position.z;
    fastest = std::max(fastest, std::abs(z - poses.all()[i - 1]->pose.position.z) / 1e-3);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  EXPECT_LT(fastest, 2 * kSpeed) << "it catches up";
  EXPECT_GT(high - low, 0.8 * kWay) << "it follows no more";
}

INSTANTIATE_TEST_SUITE_P(Matrix, HungHandTest,
                         testing::Values(FaultyStream{Stream::kHand, StreamFault::kRepeats, true}),
                         [](const auto& of) { return nameOf(of.param); });

std::vector<FaultyStream> allFaultyStreams() {
  std::vector<FaultyStream> all;
  for (const Stream stream : {Stream::kMeasured, Stream::kPredicted, Stream::kNeedle, Stream::kHand}) {
    for (int fault = 0; fault <= static_cast<int>(StreamFault::kZero); ++fault) {
      for (const bool by_hand : {true, false}) {
        if (by_hand || stream != Stream::kHand) all.push_back({stream, static_cast<StreamFault>(fault), by_hand});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Matrix, StreamFaultsTest, testing::ValuesIn(allFaultyStreams()),
                         [](const auto& of) { return nameOf(of.param); });

}  // namespace
}  // namespace microinjection
