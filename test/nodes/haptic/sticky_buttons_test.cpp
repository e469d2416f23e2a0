// A joy_node whose buttons toggle at each press: its dead-man button would stay pressed when it is let go.

#include <gtest/gtest.h>

#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

TEST(StickyButtons, AreRefusedByTheNameOfTheirNode) {
  for (const bool sticky : {false, true}) {
    SCOPED_TRACE(sticky);
    VirtualSession session({"hand.device:=joy"});
    TestNode& driver = session.addTestNode("driver");
    session.world().hear<sensor_msgs::Joy>("haptic/operator_present");
    session.executive().network().setParameter("/driver/sticky_buttons", YAML::Node(sticky));
    session.add("haptic_device", "{diagnostic_period: 0.1}");
    sensor_msgs::Joy message;
    message.axes.resize(6);
    message.buttons.resize(11);
    message.buttons[4] = 1;  // the dead-man's
    driver.repeat("joy", message);
    session.run(1);
    const auto present = [&] {
      return session.world().hear<sensor_msgs::Joy>("haptic/operator_present").newest()->buttons.at(0);
    };
    EXPECT_EQ(present(), sticky ? 0 : 1);
    EXPECT_EQ(session.diagnostics().ever("haptic_device: device", "/driver/sticky_buttons is true"), sticky)
        << session.diagnostics().text("haptic_device: device");
    if (!sticky) continue;
    driver.silence("joy");
    session.executive().network().setParameter("/driver/sticky_buttons", YAML::Node(false));
    session.run(0.5);
    driver.repeat("joy", message);
    session.run(1);
    EXPECT_EQ(present(), 1) << "its driver was started again";
  }
}

}  // namespace
}  // namespace microinjection
