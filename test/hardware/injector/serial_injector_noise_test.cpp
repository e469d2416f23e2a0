#include "hardware/injector/serial_injector_fixture.h"

#include <cmath>
#include <random>

namespace microinjection {
namespace {

/// A hundred thousand random, cut and damaged replies, late, twice and among good ones: no crash, no pressure that was
/// not sent, no pulse twice, and with a device in order again it works again.
TEST_F(SerialInjectorTest, MalformedRepliesDoNoHarm) {
  std::mt19937 random(3);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::uint64_t id = 0;
  int asked = 0, heard = 0, malformed = 0;
  while (malformed < 100000) {
    injector.step(time += 0.05);
    if (below(20) == 0 && injector.pulse({++id, 10e3, 0.01}).empty()) ++asked;
    if (below(20) == 0) injector.reset();
    if (below(5000) == 0) script.open = false;
    for (; answered < script.sent.size(); ++answered) heard += script.sent[answered][0] == 'P' ? 1 : 0;
    std::string reply = below(2) == 0 ? "OK\r" : "=12.5\r";
    if (below(3) == 0) reply.resize(below(reply.size()));
    if (below(3) == 0 && !reply.empty()) reply[below(reply.size())] = static_cast<char>(128 + below(128));
    if (below(10) == 0) reply.assign(below(600), static_cast<char>(below(128)));
    if (below(2) == 0) {
      script.incoming += reply;
      malformed += reply == "OK\r" || reply == "=12.5\r" ? 0 : 1;
    }
    const double pressure = injector.reading().pressure;
    ASSERT_TRUE(std::abs(pressure - 1250) < 1e-9 || (pressure >= 999 && pressure <= 10e3)) << pressure;
  }
  EXPECT_LE(heard, asked);
  EXPECT_LE(injector.reading().pulses, static_cast<unsigned>(heard));
  EXPECT_GT(injector.badReplies(), 10000U);
  script.incoming.clear();
  answered = script.sent.size();
  run(2);
  injector.reset();
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({++id, 10e3, 0.01}), "");
  run(1);
  EXPECT_EQ(injector.reading().last_id, id);
}

}  // namespace
}  // namespace microinjection
