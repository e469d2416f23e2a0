// What a pulse has injected is told only where it is known.

#include <algorithm>

#include "hardware/injector/dialogue_fixture.h"
#include "hardware/injector/femtojet_emulator.h"
#include "hardware/injector/injector_bench.h"

namespace microinjection {
namespace {

constexpr double kTurned = 7700;  // Pa, gauge

/// Its knob is turned at any time from the command on: the pulse counts only if all of it had the commanded pressure.
TEST(UnknownDose, AFemtojetWhoseKnobIsTurnedDoesNotTellTheCommandedDose) {
  int counted = 0, refused = 0, harmed = 0;
  for (double after = 0; after < 1.6; after += 0.01) {
    SCOPED_TRACE(after);
    const auto emulator = std::make_shared<FemtojetEmulator>();
    InjectorBench bench("femtojet", injectorFile("femtojet"), nullptr, emulator);
    bench.run(2);
    const double before = bench.device().reading().volume;
    ASSERT_EQ(bench.device().pulse({5, InjectorBench::kPressure, 0.5}), "");
    double least = InjectorBench::kPressure;  // Pa, in the pulse
    bool turned = false;
    for (double time = 0; time < 4; time += InjectorBench::kStep) {
      if (time >= after && !std::exchange(turned, true)) emulator->turnInjectionPressure(kTurned);
      bench.step();
      if (bench.pressure() > bench.balance()) least = std::min(least, bench.pressure());
    }
    const InjectorReading& reading = bench.device().reading();
    EXPECT_FALSE(reading.busy);
    harmed += least < InjectorBench::kPressure ? 1 : 0;
    if (reading.pulses == 1) {
      ++counted;
      EXPECT_EQ(bench.device().fault(), "");
      EXPECT_EQ(least, InjectorBench::kPressure);
      EXPECT_EQ(reading.last_id, 5U);
      continue;
    }
    ++refused;
    EXPECT_EQ(reading.last_id, 0U);
    EXPECT_NE(bench.device().fault().find("it reads back 77 instead of 200"), std::string::npos)
        << bench.device().fault();
    const InjectorModelConfig model = InjectorFile(injectorFile("femtojet")).model;
    const double leaks = PipetteFlow(model.pipette).flow(model.balance) * 4;  // m^3, at the balance pressure
    EXPECT_LE(reading.volume - before, 1.01 * leaks);
  }
  EXPECT_GT(counted, 20);
  EXPECT_GT(refused, 20);
  EXPECT_GT(harmed, 20);
}

TEST(UnknownDose, AfterAPulseThatCouldNotBeVerifiedTheNextOneCounts) {
  const auto emulator = std::make_shared<FemtojetEmulator>();
  InjectorBench bench("femtojet", injectorFile("femtojet"), nullptr, emulator);
  bench.run(2);
  bench.device().pulse({5, InjectorBench::kPressure, 0.5});
  bench.run(0.6);
  emulator->turnInjectionPressure(kTurned);
  bench.run(2);
  EXPECT_NE(bench.device().fault(), "");
  EXPECT_NE(bench.device().pulse({6, InjectorBench::kPressure, 0.5}), "");
  bench.device().reset();
  ASSERT_EQ(bench.device().pulse({7, InjectorBench::kPressure, 0.5}), "");
  bench.run(2);
  EXPECT_EQ(bench.device().fault(), "");
  EXPECT_EQ(bench.device().reading().pulses, 1U);
  EXPECT_EQ(bench.device().reading().last_id, 7U);
}

/// Queries find that nobody answers; from then on nothing is added.
TEST(UnknownDose, TheVolumeOfADeviceThatDoesNotAnswerDoesNotGrow) {
  for (const Injector& injector : injectors()) {
    SCOPED_TRACE(injector.name);
    InjectorBench bench(injector.name);
    bench.run(2);
    const auto volume = [&] { return bench.device().reading().volume; };
    const double known = volume();
    bench.run(1);
    EXPECT_GT(volume(), known);
    bench.emulator().inject({Fault::Kind::kSilence, 10, "", bench.time()});
    for (int i = 0; i < 1000 && bench.device().fault().empty(); ++i) bench.step();
    ASSERT_NE(bench.device().fault(), "");
    const double lost = volume();
    bench.run(3);
    EXPECT_EQ(volume(), lost);
    bench.wire().disconnectCable();
    bench.run(1);
    EXPECT_EQ(volume(), lost);
    bench.wire().connectCable();
    bench.run(9);
    bench.device().reset();  // also the volume
    bench.run(3);
    EXPECT_EQ(bench.device().fault(), "");
    EXPECT_GT(volume(), 0);
  }
}

using UnknownDoseTest = DialogueTest;

TEST_F(UnknownDoseTest, APulseWithoutAReplyIsLeftOutOfTheVolume) {
  run(1);
  answers.erase("G");
  injector.pulse({5, 12300, 3});
  while (injector.fault().empty()) run(0.01);
  EXPECT_NE(injector.fault().find("the volume leaves it out"), std::string::npos) << injector.fault();
  const double before = injector.reading().volume;
  run(2.5);
  EXPECT_EQ(injector.reading().volume, before) << "a pulse may be under way";
  EXPECT_EQ(injector.reading().pulses, 0U);
  run(3);
  EXPECT_GT(injector.reading().volume, before) << "the balance pressure is there again";
}

/// A trigger whose end was lost is executed with the end of the next line.
TEST_F(UnknownDoseTest, APulseWithoutAReplyMayBeginWithTheNextLine) {
  run(1);
  answers.erase("G");
  injector.pulse({5, 12300, 0.2});
  while (injector.fault().empty()) run(0.01);
  injector.reset();
  ASSERT_EQ(injector.fault(), "") << "by itself it would be over";
  injector.setBalance(1200);
  answers.erase("C");
  for (long sent = count("C12.0"); count("C12.0") == sent;) run(0.01);
  EXPECT_EQ(injector.fault(), "a pulse may be under way");
  run(0.25);
  EXPECT_EQ(injector.fault(), "a pulse may be under way");
  run(0.1);
  EXPECT_EQ(injector.fault(), "");
}

class VerifiedPulseTest : public DialogueTest {
 protected:
  VerifiedPulseTest()
      : DialogueTest(std::string(kSetSetTrigger) +
                     "verify: [{send: 'V', expect: 'V=([0-9.]+)', confirm: pressure_hPa}]\n") {
    answers["V"] = "V=123.0";
  }
};

TEST_F(VerifiedPulseTest, CountsWhenItIsConfirmed) {
  run(1);
  injector.pulse({5, 12300, 0.5});
  run(0.3);
  EXPECT_TRUE(injector.reading().busy);
  run(1.3);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.reading().last_id, 5U);
  EXPECT_EQ(count("V"), 1);
}

TEST_F(VerifiedPulseTest, AStopLeavesNothingToVerify) {
  run(1);
  injector.pulse({5, 12300, 30});
  run(1);
  ASSERT_TRUE(injector.reading().busy);
  EXPECT_EQ(injector.stop(), "");
  run(1);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(count("V"), 0);
}

TEST_F(VerifiedPulseTest, WithoutAnAnswerOrALineItIsAFault) {
  for (const bool breaks : {false, true}) {
    SCOPED_TRACE(breaks);
    injector.reset();
    answers["V"] = "V=123.0";
    run(1);
    const unsigned before = injector.reading().pulses;
    ASSERT_EQ(injector.pulse({breaks ? 6U : 5U, 12300, 0.5}), "");
    run(0.3);
    if (breaks) script.open = false;
    answers.erase("V");
    run(4);
    EXPECT_NE(injector.fault().find("what it has injected is unknown"), std::string::npos) << injector.fault();
    EXPECT_EQ(injector.reading().pulses, before);
    EXPECT_FALSE(injector.reading().busy);
  }
}

/// A line that a device sends by itself is neither a reply nor noise.
TEST(IgnoredLines, AreNoNoise) {
  for (const bool ignores : {false, true}) {
    WireScript script;
    SerialInjector injector(std::make_unique<ScriptedWire>(script),
                            testProtocol(std::string(kTestProtocol) + (ignores ? "ignore: '#.*'\n" : "")),
                            InjectorModelConfig());
    std::size_t answered = 0;
    double time = 0;
    for (int i = 0; i < 300; ++i) {
      injector.step(time += 0.01);
      if (i % 5 == 0) script.incoming += "# 12 hPa";
      if (i % 5 == 1) script.incoming += "\r";
      for (; i % 5 == 3 && answered < script.sent.size(); ++answered) {
        script.incoming += script.sent[answered][0] == '?' ? "=5.0\r" : "OK\r";
      }
    }
    EXPECT_EQ(injector.fault().empty(), ignores) << injector.fault();
  }
}

}  // namespace
}  // namespace microinjection
