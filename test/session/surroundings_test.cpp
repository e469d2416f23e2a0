#include "session/surroundings.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

namespace microinjection {
namespace {

class SurroundingsTest : public testing::Test {
 protected:
  SurroundingsTest() {
    ForeignProcess rviz;
    rviz.name = rviz.package = rviz.program = "rviz";
    plan_.processes = {rviz};
  }
  /// All warnings, a line each.
  std::string warnings() const {
    std::string text;
    for (const std::string& warning : surroundingsWarnings(plan_, [this](const char* name) -> const char* {
           const auto found = environment_.find(name);
           return found == environment_.end() ? nullptr : found->second.c_str();
         }))
      text += warning + "\n";
    return text;
  }
  bool warnsOf(const std::string& part) const { return warnings().find(part) != std::string::npos; }

  SessionPlan plan_;
  std::map<std::string, std::string> environment_;
};

TEST_F(SurroundingsTest, RvizWithoutADisplayIsNamed) {
  EXPECT_TRUE(warnsOf("no DISPLAY")) << warnings();
  environment_["DISPLAY"] = "";
  EXPECT_TRUE(warnsOf("no DISPLAY")) << warnings();
  for (const char* display : {":98765", ":98765.0", ":none", ":"}) {
    environment_["DISPLAY"] = display;
    EXPECT_TRUE(warnsOf(std::string("no X server answers on DISPLAY = ") + display)) << warnings();
  }
  environment_["DISPLAY"] = "localhost:10.0";  // of ssh -X
  EXPECT_EQ(warnings(), "");
  plan_.processes.clear();
  environment_.clear();
  EXPECT_EQ(warnings(), "") << "without rviz";
}

TEST_F(SurroundingsTest, ADisplayWhoseServerAnswersIsOne) {
  const std::string number = std::to_string(20000 + getpid() % 10000), path = "/tmp/.X11-unix/X" + number;
  sockaddr_un address{};  // an abstract socket, as X servers have, too
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, path.data(), path.size());
  const int server = socket(AF_UNIX, SOCK_STREAM, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + path.size());
  ASSERT_EQ(bind(server, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(server, 4), 0);
  for (const char* screen : {"", ".0"}) {
    environment_["DISPLAY"] = ":" + number + screen;
    EXPECT_EQ(warnings(), "");
  }
  close(server);
  EXPECT_TRUE(warnsOf("no X server answers")) << warnings();
}

TEST_F(SurroundingsTest, TheRosOfCondaIsNamedWhereItComesFirst) {
  plan_.processes.clear();
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("surroundings_" + std::to_string(getpid()));
  for (const char* place : {"conda/bin", "usr/bin"}) {
    std::filesystem::create_directories(folder / place);
    std::ofstream(folder / place / "roslaunch") << "#!/bin/sh\n";
    std::filesystem::permissions(folder / place / "roslaunch", std::filesystem::perms::owner_all);
  }
  const std::string conda = folder / "conda", usr = folder / "usr/bin";
  environment_ = {{"CONDA_PREFIX", conda}, {"PATH", "/nowhere::" + conda + "/bin:" + usr}};
  EXPECT_TRUE(warnsOf(conda + "/bin/roslaunch comes first on the PATH")) << warnings();
  environment_["PATH"] = usr + ":" + conda + "/bin";
  EXPECT_EQ(warnings(), "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace microinjection
