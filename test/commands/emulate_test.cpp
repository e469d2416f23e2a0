// The command as its users run it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

/// It would run until it is interrupted: the time limit ends what does not end by itself.
TEST(EmulateCommand, OutputThatCannotBeWrittenIsAnError) {
  const std::string folder = testing::TempDir() + "microinjection_emulate/";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const std::string& arguments : {std::string("mp285 --link " + folder + "port"), std::string("--help")}) {
    const std::string command = "timeout 60 " MICROINJECTION_EMULATE " " + arguments + " </dev/null >/dev/full 2>";
    EXPECT_EQ(WEXITSTATUS(std::system((command + folder + "err.txt").c_str())), 2) << arguments;
    std::ostringstream error;
    error << std::ifstream(folder + "err.txt").rdbuf();
    EXPECT_NE(error.str().find("emulate: the standard output: cannot be written: No space left"), std::string::npos)
        << error.str();
  }
  EXPECT_FALSE(fs::is_symlink(folder + "port")) << "the link was left";
  fs::remove_all(folder);
}

}  // namespace
