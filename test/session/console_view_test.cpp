#include "session/console_view.h"

#include <regex>
#include <set>
#include <sstream>

#include "base/config_reader.h"
#include "session/session_choices.h"
#include "session_folder.h"

namespace microinjection {
namespace {

std::vector<std::string> tasks() {
  std::vector<std::string> names = SessionChoices(kPackage).consoles;
  names.erase(std::find(names.begin(), names.end(), "none"));
  return names;
}

std::string fileText(const std::string& path) {
  std::ifstream in(kPackage + "/" + path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::set<std::string> displayNames(const YAML::Node& view) {
  std::set<std::string> names;
  for (const auto& display : view["Visualization Manager"]["Displays"]) names.insert(display["Name"].as<std::string>());
  return names;
}

TEST(ConsoleView, OverridesByKeyAndByName) {
  const YAML::Node base = YAML::Load("{a: 1, b: {c: 2, d: 3}, list: [{Name: x, is_on: true, k: 4}, {Name: y}]}");
  const YAML::Node task = YAML::Load("{b: {c: 5}, list: [{Name: z}, {Name: x, is_on: false}], e: 6}");
  const YAML::Node expected =
      YAML::Load("{a: 1, b: {c: 5, d: 3}, list: [{Name: x, is_on: false, k: 4}, {Name: y}, {Name: z}], e: 6}");
  EXPECT_EQ(YAML::Dump(mergedView(base, task)), YAML::Dump(expected));
  EXPECT_EQ(base["list"][0]["is_on"].as<std::string>(), "true") << "a copy";
}

TEST(ConsoleView, EveryTaskHasItsConsoleAndTheScene) {
  const std::set<std::string> scene = displayNames(loadYamlMap(kPackage + "/config/session.rviz"));
  const std::vector<std::string> names = tasks();
  for (const char* task : {"inject", "teleoperate", "train", "calibrate", "paper"})
    EXPECT_EQ(std::count(names.begin(), names.end(), task), 1) << task;
  for (const std::string& task : names) {
    const YAML::Node view = YAML::Load(consoleView(kPackage, task));
    ASSERT_EQ(view["Panels"].size(), 2u) << task;
    EXPECT_EQ(view["Panels"][0]["Class"].as<std::string>(), "microinjection/ConsolePanel") << task;
    EXPECT_EQ(view["Panels"][1]["Class"].as<std::string>(), "microinjection/MicroscopePanel") << task;
    // A misspelt Name would be added as a display without a class.
    EXPECT_EQ(displayNames(view), scene) << task;
    for (const auto& display : view["Visualization Manager"]["Displays"])
      EXPECT_TRUE(display["Class"].IsDefined()) << task;
  }
}

TEST(ConsoleView, EveryPartIsOneOfThePanel) {
  const std::string source = fileText("src/operation/console/console_parts.cpp");
  std::smatch words;
  ASSERT_TRUE(std::regex_search(source, words, std::regex("kWords\\[\\] = \\{([^}]*)\\}")));
  const std::string list = words[1];
  std::set<std::string> known;
  const std::regex word("\"(\\w+)\"");
  for (std::sregex_iterator each(list.begin(), list.end(), word), end; each != end; ++each) known.insert((*each)[1]);
  EXPECT_GT(known.size(), 5u);
  for (const std::string& task : tasks()) {
    std::istringstream parts(YAML::Load(consoleView(kPackage, task))["Panels"][0]["Parts"].as<std::string>());
    for (std::string part; parts >> part;) EXPECT_EQ(known.count(part), 1u) << task << ": " << part;
  }
}

TEST(ConsoleView, EveryPanelIsInThePluginDescription) {
  const std::string description = fileText("config/console/plugin_description.xml");
  for (const std::string& task : tasks()) {
    for (const auto& panel : YAML::Load(consoleView(kPackage, task))["Panels"])
      EXPECT_NE(description.find("class name=\"" + panel["Class"].as<std::string>() + "\""), std::string::npos) << task;
  }
}

}  // namespace
}  // namespace microinjection
