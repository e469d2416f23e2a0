#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace microinjection {

/// A command that is run as its users run it, in a folder of its own.
class CommandTest : public testing::Test {
 protected:
  struct Outcome {
    int status;
    std::string out, err;
  };

  /// `program`: path of the command; `name`: of its folder.
  CommandTest(const std::string& program, const std::string& name)
      : program_(program), directory_(testing::TempDir() + "microinjection_" + name + "/") {}

  void SetUp() override {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  static std::string read(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  Outcome run(const std::string& arguments) const {
    const std::string command = "cd " + directory_ + " && " + program_ + " " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), read(directory_ + "out.txt"), read(directory_ + "err.txt")};
  }

  const std::string program_, directory_;
};

}  // namespace microinjection
