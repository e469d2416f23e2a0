#include "session/launch_file.h"

#include <tinyxml2.h>

#include <regex>

#include "base/config_reader.h"
#include "session/parameter_tree.h"
#include "session_folder.h"

namespace microinjection {
namespace {

using tinyxml2::XMLElement;

class LaunchFileTest : public SessionFolder {
 protected:
  const XMLElement* launch(const std::vector<std::string>& arguments, const std::string& view_file = "") {
    const SessionPlan plan = planOf(session(arguments), SessionClock::kWall);
    EXPECT_EQ(document_.Parse(launchText(plan, view_file).c_str()), tinyxml2::XML_SUCCESS);
    return document_.RootElement();
  }
  const XMLElement* node(const std::vector<std::string>& arguments, const std::string& name,
                         const std::string& view_file = "") {
    const XMLElement* node = launch(arguments, view_file)->FirstChildElement("node");
    while (node && !node->Attribute("name", name.c_str())) node = node->NextSiblingElement("node");
    EXPECT_NE(node, nullptr) << name;
    return node;
  }
  static std::string text(const char* attribute) { return attribute ? attribute : "-"; }

  tinyxml2::XMLDocument document_;
};

TEST_F(LaunchFileTest, HasTheNodesWithTheirParametersAndNothingElse) {
  const XMLElement* root = launch({"cell:=zebrafish_embryo", "camera.source:=sim", "hidden:=human_oocyte"});
  const SessionPlan plan =
      planOf(session({"cell:=zebrafish_embryo", "camera.source:=sim", "hidden:=human_oocyte"}), SessionClock::kWall);
  const YAML::Node global = YAML::Load(root->FirstChildElement("rosparam")->GetText());
  EXPECT_EQ(global["robot_description"].Scalar(), plan.parameters["robot_description"].Scalar());
  std::vector<std::string> names;
  for (const XMLElement* node = root->FirstChildElement("node"); node; node = node->NextSiblingElement("node")) {
    names.push_back(node->Attribute("name"));
    const NodePlan* planned = plan.node(names.back());
    if (!planned) continue;
    EXPECT_STREQ(node->Attribute("clear_params"), "true");
    EXPECT_EQ(parameterText(YAML::Load(node->FirstChildElement("rosparam")->GetText())),
              parameterText(planned->parameters));
    std::map<std::string, std::string> remaps;
    for (const XMLElement* each = node->FirstChildElement("remap"); each; each = each->NextSiblingElement("remap"))
      remaps[each->Attribute("from")] = each->Attribute("to");
    EXPECT_EQ(remaps, planned->remaps);
  }
  EXPECT_EQ(names, plan.names());
  EXPECT_EQ(root->FirstChildElement("include"), nullptr);
}

/// The node that the operator starts in a terminal refuses what it does not know.
TEST_F(LaunchFileTest, AKeyboardHasTheParametersOfThisSessionOnly) {
  const XMLElement* root = launch({"hand.device:=keyboard"});
  const XMLElement* group = root->FirstChildElement("group");
  ASSERT_NE(group, nullptr);
  EXPECT_STREQ(group->Attribute("ns"), "keyboard_hand");
  EXPECT_STREQ(group->Attribute("clear_params"), "true");
  const SessionPlan plan = planOf(session({"hand.device:=keyboard"}), SessionClock::kWall);
  EXPECT_EQ(parameterText(YAML::Load(group->FirstChildElement("rosparam")->GetText())),
            parameterText(plan.parameters["keyboard_hand"]));
  EXPECT_FALSE(YAML::Load(root->FirstChildElement("rosparam")->GetText())["keyboard_hand"].IsDefined());
}

TEST_F(LaunchFileTest, StartsNodesAsTheyAreMeant) {
  const std::vector<std::string> all = {"hand.device:=omni", "record.folder:=/out", "camera.source:=sim",
                                        "rig.name:=emulated_zaber", "sensor.mounting:=[0, 0, 0.05, 0, 0, 1.5]"};
  EXPECT_EQ(text(node(all, "haptic_device")->Attribute("respawn")), "true");
  EXPECT_EQ(text(node(all, "session_recorder")->Attribute("required")), "true");
  EXPECT_EQ(text(node(all, "vision")->Attribute("launch-prefix")), "nice -n 10");
  EXPECT_EQ(text(node(all, "injection_controller")->Attribute("launch-prefix")), "-");
  EXPECT_EQ(text(node(all, "injection_controller")->Attribute("output")), "screen");
  EXPECT_EQ(text(node(all, "force_sensor_frame")->Attribute("args")),
            "0.0 0.0 0.05 0.0 0.0 1.5 needle_tip force_sensor");
  EXPECT_EQ(text(node(all, "force_sensor_frame")->Attribute("pkg")), "tf2_ros");
  EXPECT_NE(text(node(all, "emulated_zaber")->Attribute("args")).find("zaber --link "), std::string::npos);
  EXPECT_EQ(text(node(all, "robot_state_publisher")->Attribute("args")), "-");
}

TEST_F(LaunchFileTest, ShowsAConsoleByAFileOfItsOwn) {
  const std::vector<std::string> console = {"display.console:=inject"};
  EXPECT_EQ(text(node(console, "rviz", "/tmp/a.rviz")->Attribute("args")), "-d /tmp/a.rviz");
  EXPECT_STREQ(node(console, "rviz")->FirstChildElement("env")->Attribute("name"), "LC_ALL");
  EXPECT_NE(rvizView(planOf(session(console), SessionClock::kWall)).find("ConsolePanel"), std::string::npos);
  EXPECT_EQ(rvizView(planOf(session({"display.rviz:=true"}), SessionClock::kWall)), "");
}

TEST_F(LaunchFileTest, KeepsTextsThatXmlOrYamlWouldRead) {
  const std::string name = "O'Brien & \"<Co>\": #1";
  const XMLElement* recorder = node({"record.folder:=/out", "record.trainee:=" + name}, "session_recorder");
  EXPECT_EQ(YAML::Load(recorder->FirstChildElement("rosparam")->GetText())["training"]["trainee"].Scalar(), name);
}

/// launch/session.launch: each argument sets the key that its text names.
TEST_F(LaunchFileTest, TheArgumentsOfSessionLaunchAreKeys) {
  ASSERT_EQ(document_.LoadFile((kPackage + "/launch/session.launch").c_str()), tinyxml2::XML_SUCCESS);
  const XMLElement* root = document_.RootElement();
  const std::string command = root->FirstChildElement("param")->Attribute("command");
  const YAML::Node keys = loadYamlMap(kPackage + "/config/sessions/default.yaml");
  int checked = 0;
  const std::regex key_of("([a-z_.]+): .*");
  for (const XMLElement* arg = root->FirstChildElement("arg"); arg; arg = arg->NextSiblingElement("arg")) {
    std::smatch found;
    const std::string name = arg->Attribute("name"), doc = text(arg->Attribute("doc"));
    if (!std::regex_match(doc, found, key_of)) continue;
    const std::string key = found[1];
    EXPECT_TRUE(parameterAt(keys, std::regex_replace(key, std::regex("\\."), "/")).IsDefined()) << name << ": " << key;
    EXPECT_NE(command.find(key + ":=$(arg " + name + ")"), std::string::npos) << name;
    EXPECT_STREQ(arg->Attribute("default"), "") << name;
    ++checked;
  }
  EXPECT_GE(checked, 14);
  for (const char* name : {"session", "set", "only", "generated"})
    EXPECT_NE(command.find(std::string("$(arg ") + name + ")"), std::string::npos) << name;
}

/// A node refuses parameters that it does not know.
TEST_F(LaunchFileTest, NoParameterOfSessionLaunchIsANodes) {
  ASSERT_EQ(document_.LoadFile((kPackage + "/launch/session.launch").c_str()), tinyxml2::XML_SUCCESS);
  const Session all = session({"camera.source:=sim", "record.folder:=/out", "estimator:=true", "hidden:=mouse_oocyte"});
  const SessionPlan plan = planOf(all, SessionClock::kWall);
  const XMLElement* param = document_.RootElement()->FirstChildElement("param");
  for (; param; param = param->NextSiblingElement("param"))
    for (const std::string& name : plan.names()) EXPECT_NE(text(param->Attribute("name")).find("/" + name + "/"), 0u);
}

TEST_F(LaunchFileTest, EachSessionOfThePackageHasAPlan) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kPackage + "/config/sessions")) {
    const std::string name = entry.path().stem().string();
    EXPECT_EQ(refusalOf([&] { planOf(Session::load(name, {}, kPackage), SessionClock::kWall); }), "") << name;
    ++count;
  }
  EXPECT_GE(count, 5);
}

}  // namespace
}  // namespace microinjection
