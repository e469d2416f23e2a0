#pragma once

#include <functional>
#include <string>
#include <vector>

#include "session/session_plan.h"

namespace microinjection {

/// Warnings of what would end a part of a live session, or put another one in its place, without a word: no display for
/// rviz, conda's ROS. They are no refusals, since other hosts may start these parts. `variable`: of the environment, by
/// its name; null or "" where there is none, as std::getenv.
std::vector<std::string> surroundingsWarnings(const SessionPlan& plan,
                                              const std::function<const char*(const char*)>& variable);

}  // namespace microinjection
