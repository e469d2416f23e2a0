#include "operation/control/injection_goal.h"

#include <sstream>

namespace microinjection {
namespace {

using Limits = InjectionGoalLimits;

const Range kLayers = Range::closed(1, Limits::kLayers);

/// A number of a goal: its key, in the section pulse or outside of it, and its range.
struct Number {
  bool of_pulse;
  const char* key;
  const char* unit;
  Range allowed;
  double& (*in)(InjectionGoal& goal);
};

const Number kNumbers[] = {
    {false, "depth", "m", {0, Limits::kDistance, true, false}, [](InjectionGoal& g) -> double& { return g.depth; }},
    {false, "margin", "m", Range::closed(0, Limits::kDistance), [](InjectionGoal& g) -> double& { return g.margin; }},
    {false, "hold_time", "s", Range::closed(0, Limits::kHoldTime),
     [](InjectionGoal& g) -> double& { return g.hold_time; }},
    {true, "pressure", "Pa", Range::closed(0, Limits::kPressure),
     [](InjectionGoal& g) -> double& { return g.pulse.pressure; }},
    {true, "duration", "s", Range::closed(0, Limits::kDuration),
     [](InjectionGoal& g) -> double& { return g.pulse.duration; }},
    {true, "volume", "m^3", Range::closed(0, Limits::kVolume),
     [](InjectionGoal& g) -> double& { return g.pulse.volume; }},
};

}  // namespace

InjectionGoal InjectionGoal::read(ConfigReader& reader) {
  InjectionGoal goal;
  reader.boolean("puncture", goal.puncture);
  reader.integer("layers", goal.layers, kLayers);
  ConfigReader pulse = reader.section("pulse");
  for (const Number& number : kNumbers) {
    (number.of_pulse ? pulse : reader).number(number.key, number.in(goal), number.allowed);
  }
  return goal;
}

std::string InjectionGoal::problems() const {
  std::ostringstream text;
  const auto check = [&text](const std::string& key, double value, const Range& allowed, const std::string& unit) {
    if (allowed.contains(value)) return;
    text << (text.tellp() > 0 ? "; " : "") << key << " = " << value << unit << ", allowed " << allowed.text() << unit;
  };
  check("layers", layers, kLayers, "");
  InjectionGoal goal = *this;
  for (const Number& number : kNumbers) {
    check((number.of_pulse ? "pulse/" : "") + std::string(number.key), number.in(goal), number.allowed,
          std::string(" ") + number.unit);
  }
  return text.str();
}

const char* toText(InjectionOutcome outcome) {
  constexpr const char* kWords[] = {"none",          "injected",          "punctured",    "indented",  "no_contact",
                                    "not_punctured", "injector_time_out", "not_injected", "preempted", "guard",
                                    "fault",         "disabled"};
  return kWords[static_cast<int>(outcome)];
}

}  // namespace microinjection
