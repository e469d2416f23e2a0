#include "operation/control/injection_goal.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace microinjection {
namespace {

using Limits = InjectionGoalLimits;

const Range kLayers = Range::closed(1, Limits::kLayers);

constexpr const char* kBreakBy[] = {"force", "suction", "suction_then_force", "force_then_suction"};

/// A number of a goal: its section, none of it empty, its key and its range.
struct Number {
  const char* section;
  const char* key;
  const char* unit;
  Range allowed;
  double& (*in)(InjectionGoal& goal);
};

const Number kNumbers[] = {
    {"", "depth", "m", {0, Limits::kDistance, true, false}, [](InjectionGoal& g) -> double& { return g.depth; }},
    {"", "margin", "m", Range::closed(0, Limits::kDistance), [](InjectionGoal& g) -> double& { return g.margin; }},
    {"", "hold_time", "s", Range::closed(0, Limits::kHoldTime),
     [](InjectionGoal& g) -> double& { return g.hold_time; }},
    {"pulse", "pressure", "Pa", Range::closed(0, Limits::kPressure),
     [](InjectionGoal& g) -> double& { return g.pulse.pressure; }},
    {"pulse", "duration", "s", Range::closed(0, Limits::kDuration),
     [](InjectionGoal& g) -> double& { return g.pulse.duration; }},
    {"pulse", "volume", "m^3", Range::closed(0, Limits::kVolume),
     [](InjectionGoal& g) -> double& { return g.pulse.volume; }},
    {"suction", "dent", "m", Range::closed(0, Limits::kDistance),
     [](InjectionGoal& g) -> double& { return g.suction.dent; }},
    {"suction",
     "largest",
     "Pa",
     {0, Limits::kSuction, true, false},
     [](InjectionGoal& g) -> double& { return g.suction.largest; }},
    {"suction", "rate", "Pa/s", Range::closed(0, Limits::kPressure),
     [](InjectionGoal& g) -> double& { return g.suction.rate; }},
    {"suction", "time", "s", Range::closed(0, Limits::kDuration),
     [](InjectionGoal& g) -> double& { return g.suction.time; }},
    {"suction",
     "length",
     "m",
     {0, Limits::kDistance, true, false},
     [](InjectionGoal& g) -> double& { return g.suction.length; }},
    {"holding", "suction", "Pa", Range::closed(0, Limits::kSuction),
     [](InjectionGoal& g) -> double& { return g.holding.suction; }},
    {"holding",
     "time",
     "s",
     {0, Limits::kDuration, true, false},
     [](InjectionGoal& g) -> double& { return g.holding.time; }},
    {"holding", "release_pressure", "Pa", Range::closed(0, Limits::kBlow),
     [](InjectionGoal& g) -> double& { return g.holding.release_pressure; }},
    {"holding", "release_time", "s", Range::closed(0, Limits::kDuration),
     [](InjectionGoal& g) -> double& { return g.holding.release_time; }},
};

}  // namespace

InjectionGoal InjectionGoal::read(ConfigReader& reader) {
  InjectionGoal goal;
  reader.boolean("puncture", goal.puncture);
  reader.integer("layers", goal.layers, kLayers);
  std::string by = toText(goal.break_by);
  reader.choice("break_by", by, {std::begin(kBreakBy), std::end(kBreakBy)});
  goal.break_by = breakByOf(by).value_or(goal.break_by);
  ConfigReader pulse = reader.section("pulse"), suction = reader.section("suction");
  ConfigReader holding = reader.section("holding");
  holding.boolean("release", goal.holding.release);
  for (const Number& number : kNumbers) {
    const std::string section = number.section;
    ConfigReader& keys = section == "pulse"     ? pulse
                         : section == "suction" ? suction
                         : section == "holding" ? holding
                                                : reader;
    keys.number(number.key, number.in(goal), number.allowed);
  }
  if (goal.holding.release_time >= goal.holding.time) holding.error("release_time", "must be below time");
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
    const std::string section = number.section;
    check((section.empty() ? "" : section + "/") + number.key, number.in(goal), number.allowed,
          std::string(" ") + number.unit);
  }
  if (holding.release_time >= holding.time)
    text << (text.tellp() > 0 ? "; " : "") << "holding/release_time must be below holding/time";
  return text.str();
}

const char* toText(BreakBy by) { return kBreakBy[static_cast<int>(by)]; }

std::optional<BreakBy> breakByOf(const std::string& name) {
  const auto* found = std::find(std::begin(kBreakBy), std::end(kBreakBy), name);
  if (found == std::end(kBreakBy)) return std::nullopt;
  return static_cast<BreakBy>(found - std::begin(kBreakBy));
}

const char* toText(InjectionOutcome outcome) {
  constexpr const char* kWords[] = {"none",     "injected",      "punctured",         "indented",     "no_contact",
                                    "not_held", "not_punctured", "injector_time_out", "not_injected", "preempted",
                                    "guard",    "fault",         "disabled"};
  return kWords[static_cast<int>(outcome)];
}

}  // namespace microinjection
