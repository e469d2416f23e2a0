#include "hardware/serial/fault.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/errors.h"
#include "hardware/serial/emulator.h"

namespace microinjection {
namespace {

TEST(Fault, IsReadFromText) {
  const Fault silence = parseFault("silence:2.5@7");
  EXPECT_EQ(silence.kind, Fault::Kind::kSilence);
  EXPECT_EQ(silence.amount, 2.5);
  EXPECT_EQ(silence.time, 7);
  EXPECT_EQ(parseFault("drop:3").amount, 3);
  EXPECT_EQ(parseFault("error:BADDATA").code, "BADDATA");
  EXPECT_EQ(parseFault("interrupt@0.5").kind, Fault::Kind::kInterrupt);
}

TEST(Fault, RefusesWhatIsNone) {
  for (const char* text : {"", "silent:1", "silence", "silence:", "silence:x", "silence:-1", "silence:nan", "drop:0",
                           "drop:1.5", "interrupt:1", "interrupt:", "error", "drop:1@", "drop:1@soon", "drop:1@-1"}) {
    EXPECT_THROW(parseFault(text), ConfigError) << text;
  }
}

/// Says back what it hears.
class Echo : public DeviceEmulator {
 protected:
  void process(const std::string& bytes, double) override { said_ += bytes; }
  std::string produce(double) override { return std::exchange(said_, ""); }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}
  std::string said_;
};

std::string exchange(Echo& echo, const std::string& bytes, double time) {
  echo.receive(bytes, time);
  return echo.send(time);
}

TEST(Fault, HappensToTheBytesFromItsTimeOn) {
  Echo echo;
  for (const char* fault : {"drop:2@1", "deaf:1@2", "garble:1@3", "silence:1@4"}) echo.inject(parseFault(fault));
  EXPECT_EQ(exchange(echo, "abc", 0.9), "abc");
  EXPECT_EQ(exchange(echo, "abc", 1), "c");
  EXPECT_EQ(exchange(echo, "abc", 2), "bc");
  EXPECT_EQ(exchange(echo, "abc", 3), std::string{static_cast<char>(~'a')} + "bc");
  EXPECT_EQ(exchange(echo, "abc", 4), "");
  EXPECT_EQ(exchange(echo, "abc", 4.9), "");
  EXPECT_EQ(exchange(echo, "abc", 5), "abc");
}

}  // namespace
}  // namespace microinjection
