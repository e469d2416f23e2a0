#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// Samples [begin, end) of a record in which the tip goes into the cell, and what was left out, for the user.
struct WayIn {
  std::size_t begin = 0, end = 0;
  std::vector<std::string> notes;
};

/// The way in of a record: what leads to the deepest sample, from the last turn before it on, until the tip
/// rests. Only that is loading: a hold relaxes or creeps, a way out has another force. `time`: s, or the numbers
/// of the samples; `position`: m, growing into the cell.
WayIn findWayIn(const std::vector<double>& time, const std::vector<double>& position);

/// The sample of a way in from which on the force is held while the tip creeps on; their number without a hold, and
/// where the force is not well above its noise. `force`: N, growing with the depth.
std::size_t endOfLoading(const std::vector<double>& time, const std::vector<double>& force);

/// The sample at the crest of the force before a puncture on a way in, where the force falls while the tip goes on;
/// empty without one. `force`: N, growing with the depth.
std::optional<std::size_t> crestBeforePuncture(const std::vector<double>& position, const std::vector<double>& force);

}  // namespace microinjection
