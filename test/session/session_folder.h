#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "session/session.h"

namespace microinjection {

inline const std::string kPackage = MICROINJECTION_SOURCE_DIR;

/// What is refused, or an empty text.
inline std::string refusalOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

/// A test with a folder of its own for files.
class SessionFolder : public testing::Test {
 protected:
  SessionFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("session_test_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~SessionFolder() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// The default session with some keys.
  static Session session(const std::vector<std::string>& arguments = {}) {
    return Session::load("default", arguments, kPackage);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace microinjection
