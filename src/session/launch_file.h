#pragma once

#include <string>

#include "session/session_plan.h"

namespace microinjection {

/// A roslaunch file of a plan: its nodes with their parameters and remaps, frames and processes. It includes no other.
/// `view_file`: path of the file that gets rvizView(plan).
std::string launchText(const SessionPlan& plan, const std::string& view_file);

/// The configuration of the plan's rviz; empty when there is none to be written.
std::string rvizView(const SessionPlan& plan);

}  // namespace microinjection
