#include "hardware/manipulator/needle_state.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using State = OperatingState;
using Command = StateCommand;
using DeviceState = ManipulatorDevice::State;

class NeedleStateTest : public testing::Test {
 protected:
  NeedleStateTest() { state_.setConditions({DeviceState::kReady, true, "", ""}); }
  NeedleState state_;
};

TEST_F(NeedleStateTest, PausesAndResumes) {
  EXPECT_EQ(state_.state(), State::kEnabled);
  EXPECT_EQ(state_.unavailableReason(), "");
  EXPECT_EQ(state_.command(Command::kPause), "");
  EXPECT_EQ(state_.state(), State::kPaused);
  EXPECT_EQ(state_.unavailableReason(), "PAUSED; allowed after resume");
  EXPECT_NE(state_.command(Command::kEnable), "");  // the convention's table: invalid
  EXPECT_EQ(state_.state(), State::kPaused);
  EXPECT_EQ(state_.command(Command::kResume), "");
  EXPECT_EQ(state_.state(), State::kEnabled);
  EXPECT_NE(state_.command(Command::kResume), "");
}

TEST_F(NeedleStateTest, IsDisabledUntilSomebodyEnables) {
  EXPECT_EQ(state_.command(Command::kDisable), "");
  EXPECT_EQ(state_.state(), State::kDisabled);
  EXPECT_NE(state_.command(Command::kPause), "");
  EXPECT_EQ(state_.unavailableReason(), "DISABLED; allowed after enable");
  EXPECT_EQ(state_.command(Command::kEnable), "");
  EXPECT_EQ(state_.state(), State::kEnabled);
}

TEST_F(NeedleStateTest, AFaultEndsWhereItsCommandLeads) {
  EXPECT_EQ(state_.command(Command::kPause), "");
  state_.setConditions({DeviceState::kFault, true, "", ""});
  EXPECT_EQ(state_.state(), State::kFault);
  EXPECT_NE(state_.command(Command::kPause), "");
  EXPECT_NE(state_.command(Command::kResume), "");
  EXPECT_NE(state_.command(Command::kHome), "");
  EXPECT_EQ(state_.command(Command::kEnable), "");
  EXPECT_EQ(state_.state(), State::kFault);  // its cause is not gone yet
  state_.setConditions({DeviceState::kReady, true, "", ""});
  EXPECT_EQ(state_.state(), State::kEnabled);
  state_.setConditions({DeviceState::kReady, true, "two nodes", ""});
  EXPECT_EQ(state_.state(), State::kFault);
  EXPECT_EQ(state_.command(Command::kDisable), "");
  state_.setConditions({DeviceState::kReady, true, "", ""});
  EXPECT_EQ(state_.state(), State::kDisabled);
}

TEST_F(NeedleStateTest, WithoutADeviceOrBehindABarrierItIsDisabled) {
  state_.setConditions({DeviceState::kDisconnected, false, "", ""});
  EXPECT_EQ(state_.state(), State::kDisabled);
  EXPECT_FALSE(state_.homed());
  state_.setConditions({DeviceState::kReady, true, "", "others can reach it"});
  EXPECT_EQ(state_.state(), State::kDisabled);
  EXPECT_EQ(state_.unavailableReason(), "others can reach it");
  state_.setConditions({DeviceState::kReady, true, "", ""});
  EXPECT_EQ(state_.state(), State::kEnabled);
}

TEST_F(NeedleStateTest, UnhomedItIsHeldUntilItIsHome) {
  EXPECT_TRUE(state_.homed());
  EXPECT_EQ(state_.command(Command::kUnhome), "");
  EXPECT_EQ(state_.state(), State::kEnabled);
  EXPECT_FALSE(state_.homed());
  EXPECT_EQ(state_.unavailableReason(), "the needle is not homed; allowed after home");
  state_.setConditions({DeviceState::kReady, false, "", ""});
  EXPECT_NE(state_.command(Command::kHome), "");
  state_.setConditions({DeviceState::kReady, true, "", ""});
  EXPECT_EQ(state_.command(Command::kHome), "");
  EXPECT_TRUE(state_.homed());
  EXPECT_EQ(state_.unavailableReason(), "");
}

}  // namespace
}  // namespace microinjection
