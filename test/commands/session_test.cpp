// The command as its users and roslaunch run it: what it prints, writes and refuses.

#include <string>

#include "commands/command_test.h"

namespace microinjection {
namespace {

class SessionCommand : public CommandTest {
 protected:
  SessionCommand() : CommandTest(MICROINJECTION_SESSION, "session") {}

  void write(const std::string& name, const std::string& text) const { std::ofstream(directory_ + name) << text; }
};

TEST_F(SessionCommand, ChecksASessionAndReportsWhatWasFitted) {
  for (const char* arguments : {"", "default", "injection --check", "default estimator:=true cell:="}) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("session: for a cell of 56 um"), std::string::npos) << result.err;
  }
}

TEST_F(SessionCommand, ReportsAllErrorsALineEach) {
  write("lab.yaml", "version: 1\nrig: {name: lathe}\nhand:\n  motion: nowhere.yaml\n");
  const Outcome result = run("lab.yaml estimator:=perhaps hand.devise=omni --print");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out, "");
  for (const char* part :
       {"session: /", "lab.yaml, line 2: rig/name = lathe: must be one of: sim", "lab.yaml, line 4: hand/motion",
        "\nsession: argument: estimator = perhaps", "\nsession: argument: hand/devise: unknown key"})
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

TEST_F(SessionCommand, PrintsASessionThatIsTheSame) {
  const Outcome first =
      run("default hand.device:=dvrk record.folder:=here --print >again.yaml; cp again.yaml twice.yaml; " + program_ +
          " again.yaml --print");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out, read(directory_ + "twice.yaml"));
  EXPECT_NE(first.out.find("folder: " + directory_ + "here\n"), std::string::npos) << first.out;
}

TEST_F(SessionCommand, WritesALaunchFileAndADigestOfWhatItIsMadeFrom) {
  write("lab.yaml", "version: 1\nbase: injection\ndisplay: {console: inject}\n");
  const Outcome first = run("lab.yaml --launch lab.launch");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_NE(read(directory_ + "lab.launch").find("type=\"injection_controller\""), std::string::npos);
  EXPECT_NE(read(directory_ + "lab.launch.rviz").find("ConsolePanel"), std::string::npos);
  EXPECT_EQ(run("lab.yaml --launch lab.launch").out, first.out);
  EXPECT_EQ(run("lab.yaml --launch lab.launch --only display").out, first.out);
  EXPECT_EQ(read(directory_ + "lab.launch").find("type=\"injection_controller\""), std::string::npos);
  EXPECT_NE(run("lab.yaml --launch lab.launch estimator:=true").out, first.out);
  write("lab.yaml", "version: 1\nbase: injection\ndisplay: {console: train}\n");
  EXPECT_NE(run("lab.yaml --launch lab.launch").out, first.out);
}

TEST_F(SessionCommand, PrintsNodesAndWritesAView) {
  const Outcome nodes = run("default --nodes --only \"display injector\"");
  EXPECT_EQ(nodes.out, "injector\ndisplay\n");
  EXPECT_EQ(run("display.console:=paper --view a.rviz").status, 0);
  EXPECT_NE(read(directory_ + "a.rviz").find("ConsolePanel"), std::string::npos);
}

TEST_F(SessionCommand, RefusesWrongUsage) {
  for (const auto& [arguments, what] : {std::pair<const char*, const char*>{"nobody", "no such file"},
                                        {"a.yaml b.yaml", "must be one file or name"},
                                        {"--far", "--far"},
                                        {"--only nobody", "has no such node"},
                                        {"--view a.rviz", "must be with a console"},
                                        {"--launch /proc/a.launch", "cannot be written"},
                                        {"--launch ''", "--launch"}}) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_NE(result.err.find(what), std::string::npos) << arguments << ": " << result.err;
  }
}

TEST_F(SessionCommand, HasHelp) {
  const Outcome result = run("--help");
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("KEY:=VALUE"), std::string::npos);
}

TEST_F(SessionCommand, IgnoresTheArgumentsOfRoslaunch) {
  EXPECT_EQ(run("default __name:=session __log:=/tmp/log").status, 0);
}

}  // namespace
}  // namespace microinjection
