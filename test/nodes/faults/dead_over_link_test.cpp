#include "hand_session.h"

namespace microinjection {
namespace {

/// Hand and rig with packets between them, as on two machines.
class DeadOverLink : public testing::TestWithParam<NodeFault> {
 protected:
  DeadOverLink() : session_(linked()) { session_.runIntoPhase("indent", 0.2); }

  void strike(const std::string& node) {
    struck_ = session_.strike(node, GetParam());
    session_.session().run(0.5);
  }
  void expectNeedleRests(double within) {
    HandSession::expectRests(session_.needle(), struck_, within + HandSession::kStopTime);
  }
  void expectForceEnds(double within, double earlier = 0) {
    HandSession::expectForceEnds(session_.force(), struck_, within, earlier);
  }

 private:
  static HandSession::Options linked() {
    HandSession::Options options;
    options.linked = true;
    return options;
  }

  HandSession session_;
  double struck_ = 0;
};

TEST_P(DeadOverLink, Controller) {
  strike("injection_controller");
  expectNeedleRests(0);
  expectForceEnds(HandSession::kController, 0.1);  // its state comes each 0.1 s
}

TEST_P(DeadOverLink, Follower) {
  strike("teleoperation_follower");
  expectNeedleRests(0);
  expectForceEnds(HandSession::kLink);
}

TEST_P(DeadOverLink, Bridge) {
  strike("haptic_bridge");
  expectNeedleRests(HandSession::kLink);
}

TEST_P(DeadOverLink, Hand) {
  strike("virtual_hand");
  expectNeedleRests(HandSession::kInputs);
  expectForceEnds(HandSession::kInputs, HandSession::sooner(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(KillAndFreeze, DeadOverLink, testing::Values(NodeFault::kKill, NodeFault::kFreeze));

}  // namespace
}  // namespace microinjection
