#include "operation/console/parameter_number.h"

#include <gtest/gtest.h>

#include "operation/console/hand_lines.h"
#include "operation/console/headline.h"

namespace microinjection {
namespace {

TEST(ParameterNumber, IsReadAsTheNodesReadIt) {
  std::string error;
  EXPECT_DOUBLE_EQ(parameterNumber("/injection_controller", "force_limit", "2e-5", error).value(), 2e-5);
  EXPECT_DOUBLE_EQ(parameterNumber("/injection_controller", "force_limit", "2.0e5", error).value(), 2e5);
  EXPECT_EQ(error, "");
}

TEST(ParameterNumber, IsAnErrorThatIsShownWhereItIsNone) {
  std::string error;
  EXPECT_FALSE(parameterNumber("/injection_controller", "force_limit", "2e-5 N", error));
  EXPECT_NE(error.find("/injection_controller: force_limit"), std::string::npos) << error;
  EXPECT_NE(error.find("must be a number"), std::string::npos) << error;
  EXPECT_FALSE(parameterNumber("/injection_controller", "depth_limit", "", error));
  EXPECT_NE(error.find("; /injection_controller: depth_limit"), std::string::npos) << error;

  SessionView session;
  session.operating = OperatingState::kEnabled;
  session.injection = InjectionState::kIdle;
  EXPECT_EQ(headline(session).light, Light::kGreen);
  session.settings.error = error;
  EXPECT_EQ(headline(session).light, Light::kYellow);
  EXPECT_NE(headline(session).text.find("force_limit"), std::string::npos);
  HandSettings hand;
  hand.error = error;
  EXPECT_EQ(positionScaleText(hand), error);
}

}  // namespace
}  // namespace microinjection
