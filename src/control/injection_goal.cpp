#include "control/injection_goal.h"

#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

void readInto(InjectionGoal& goal, ConfigReader& reader) {
  reader.boolean("puncture", goal.puncture);
  reader.integer("layers", goal.layers, Range::closed(1, 10));
  reader.number("depth", goal.depth, Range::positive());
  reader.number("margin", goal.margin, Range::nonNegative());
  reader.number("hold_time", goal.hold_time, Range::nonNegative());
  ConfigReader pulse = reader.section("pulse");
  pulse.number("pressure", goal.pulse.pressure, Range::finite());
  pulse.number("duration", goal.pulse.duration, Range::nonNegative());
  pulse.number("volume", goal.pulse.volume, Range::nonNegative());
}

void check(std::ostringstream& text, const char* name, double value, const Range& range) {
  if (!range.contains(value))
    text << (text.tellp() > 0 ? "; " : "") << name << " = " << value << ", allowed " << range.text();
}

}  // namespace

InjectionGoal InjectionGoal::read(ConfigReader& reader) {
  InjectionGoal goal;
  readInto(goal, reader);
  return goal;
}

std::string InjectionGoal::problems() const {
  std::ostringstream text;
  check(text, "layers", layers, Range::closed(1, 10));
  check(text, "depth", depth, Range::positive());
  check(text, "margin", margin, Range::nonNegative());
  check(text, "hold_time", hold_time, Range::nonNegative());
  check(text, "pulse/pressure", pulse.pressure, Range::finite());
  check(text, "pulse/duration", pulse.duration, Range::nonNegative());
  check(text, "pulse/volume", pulse.volume, Range::nonNegative());
  return text.str();
}

const char* toText(InjectionOutcome outcome) {
  constexpr const char* kWords[] = {"none",          "injected",          "punctured",    "indented",  "no_contact",
                                    "not_punctured", "injector_time_out", "not_injected", "preempted", "guard",
                                    "fault",         "disabled"};
  return kWords[static_cast<int>(outcome)];
}

}  // namespace microinjection
