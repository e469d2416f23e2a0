#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nodes/session/recorded_session.h"

namespace microinjection {

/// What a session is scored by.
struct RecordedMeasure {
  std::string name;             ///< in training.yaml and the history
  std::string task;             ///< the key of its reference
  double value = 0;             ///< SI
  bool is_met_exactly = false;  ///< more is as bad as less
};

/// The measures, from the rows of a session's table and nothing else: an oracle for those that the recorder writes.
inline std::vector<RecordedMeasure> trainingMeasures(const std::vector<CsvRows::Row>& all) {
  using Row = CsvRows::Row;
  using Point = std::array<double, 3>;
  const auto number = [](const Row& row, const std::string& name) {
    return row.at(name).empty() ? std::numeric_limits<double>::quiet_NaN() : toNumber(row.at(name));
  };
  const auto tip = [&](const Row& row) {
    return Point{number(row, "tip_x_m"), number(row, "tip_y_m"), number(row, "tip_z_m")};
  };
  const auto distance = [](const Point& one, const Point& other, int axes) {
    double square = 0;
    for (int i = 0; i < axes; ++i) square += (one[i] - other[i]) * (one[i] - other[i]);
    return std::sqrt(square);
  };
  const auto state = [](const Row& row) { return row.at("injection_state"); };

  std::vector<Row> rows;
  for (const Row& row : all) {
    if (!row.at("tip_x_m").empty() && !row.at("measured_axial_N").empty()) rows.push_back(row);
  }
  double peak = 0, deepest = 0, farthest = 0, volume = 0;
  int punctures = 0, layers = 0;
  std::optional<Point> entry, begin;
  std::optional<double> set_out, last_work;  // s
  double before = 0;                         // s, of the last row at work
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double time = number(row, "time_s"), depth = number(row, "depth_m");
    peak = std::max(peak, std::hypot(number(row, "measured_axial_N"), number(row, "measured_lateral_N")));
    if (!state(row).empty() && state(row) != "idle") {
      if (!begin) begin = tip(row);
      if (!set_out && distance(tip(row), *begin, 3) > 1e-6) set_out = before;
      before = time;
      if (state(row) != "approach") last_work = time;
    }
    const int now = std::stoi(row.at("layers_punctured"));
    punctures += now - layers;  // one place only
    layers = now;
    if (i > 0 && (state(row) == "punctured" || state(row) == "inject"))
      volume += number(row, "injected_volume_m3") - number(rows[i - 1], "injected_volume_m3");
    if (!(depth >= 0)) {
      entry.reset();
      continue;
    }
    if (!entry) entry = tip(row);
    if (punctures == 0) deepest = std::max(deepest, depth);
    if (std::set<std::string>{"contact", "indent", "punctured", "inject"}.count(state(row)) > 0)
      farthest = std::max(farthest, distance(tip(row), *entry, 2));
  }
  return {{"peak_force_N", "peak_force", peak, false},
          {"deformation_m", "deformation", deepest, false},
          {"lateral_error_m", "lateral_error", farthest, false},
          {"time_s", "time", last_work.value_or(0) - set_out.value_or(0), false},
          {"punctures", "punctures", static_cast<double>(punctures), true},
          {"volume_m3", "volume", volume, true}};
}

}  // namespace microinjection
