#include "base/standard_output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Ends the process: 0 when all was written, 7 with the message on stderr when not. `end`: of what is written.
[[noreturn]] void write(const char* path, std::size_t length) {
  if (std::freopen(path, "w", stdout) == nullptr) _exit(1);
  std::cout << std::string(length, 'x');
  try {
    flushStandardOutput();
  } catch (const WriteError& error) {
    std::fputs(error.what(), stderr);
    _exit(7);
  }
  _exit(0);
}

TEST(StandardOutput, AFullDiskIsAnErrorWhetherTheTextFitsTheBufferOrNot) {
  EXPECT_EXIT(write("/dev/null", 5), testing::ExitedWithCode(0), "");
  const std::string message = "the standard output: cannot be written: ";
  EXPECT_EXIT(write("/dev/full", 5), testing::ExitedWithCode(7), message + "No space left on device");
  EXPECT_EXIT(write("/dev/full", 1 << 20), testing::ExitedWithCode(7), message);
}

}  // namespace
}  // namespace microinjection
