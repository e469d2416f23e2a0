#include "vision/calibration/calibration_pattern.h"

#include "base/config_errors.h"

namespace microinjection {
namespace {

class Planner {
 public:
  Planner(const CalibrationPatternConfig& config, const Eigen::Vector3d& centre) : config_(config), centre_(centre) {
    for (int row = 0; row < config.rows; ++row) {
      for (int i = 0; i < config.columns; ++i) {
        const int column = row % 2 == 0 ? i : config.columns - 1 - i;
        grid_.push_back(pointAt(column, row));
      }
    }
  }

  std::vector<CalibrationWaypoint> make() {
    const double y = config_.depth > 0 ? -config_.take_up : 0;
    add(grid_.front().position + Eigen::Vector3d(-config_.take_up, y, -config_.take_up));
    waypoints_.insert(waypoints_.end(), grid_.begin(), grid_.end());
    const double along_x = config_.rows % 2 == 1 ? config_.take_up : -config_.take_up;
    add(grid_.back().position + Eigen::Vector3d(along_x, 0, config_.take_up));
    for (auto point = grid_.rbegin(); point != grid_.rend(); ++point)
      waypoints_.push_back({point->position, true, false});
    if (config_.depth > 0) addDepth();
    return waypoints_;
  }

 private:
  CalibrationWaypoint pointAt(int column, int row) const {
    const double x = config_.field.x() * (static_cast<double>(column) / (config_.columns - 1) - 0.5);
    const double z = config_.field.y() * (static_cast<double>(row) / (config_.rows - 1) - 0.5);
    const bool corner = (column == 0 || column == config_.columns - 1) && (row == 0 || row == config_.rows - 1);
    return {centre_ + Eigen::Vector3d(x, 0, z), true, corner && config_.depth > 0};
  }

  void add(const Eigen::Vector3d& position) { waypoints_.push_back({position, false, false}); }

  void addDepth() {
    const auto at = [&](double y) -> Eigen::Vector3d { return centre_ + Eigen::Vector3d(0, y, 0); };
    const double depth = config_.depth;
    add(at(-depth - config_.take_up));
    for (const double y : {-depth, 0.0, depth}) waypoints_.push_back({at(y), true, true});
    add(at(depth + config_.take_up));
    for (const double y : {depth, 0.0, -depth}) waypoints_.push_back({at(y), true, true});
  }

  const CalibrationPatternConfig& config_;
  Eigen::Vector3d centre_;
  std::vector<CalibrationWaypoint> grid_, waypoints_;
};

double durationOf(const CalibrationPatternConfig& config, const std::vector<CalibrationWaypoint>& waypoints,
                  Eigen::Vector3d from) {
  double duration = 0;
  for (const CalibrationWaypoint& each : waypoints) {
    duration += (each.position - from).norm() / config.speed + config.settle_time;
    duration += (each.observe ? config.observation_time : 0) + (each.focus ? config.focus_time : 0);
    from = each.position;
  }
  return duration;
}

void checkInside(const CalibrationPlan& plan, const TravelBox& box, ConfigErrors& errors) {
  Eigen::Vector3d low = plan.waypoints.front().position, high = low;
  for (const CalibrationWaypoint& each : plan.waypoints) {
    low = low.cwiseMin(each.position);
    high = high.cwiseMax(each.position);
  }
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    const Range allowed = Range::closed(box.low[i], box.high[i]);
    errors.require(allowed, "lowest " + axis + " of the pattern", low[i], " m");
    errors.require(allowed, "highest " + axis + " of the pattern", high[i], " m");
  }
}

}  // namespace

CalibrationPatternConfig CalibrationPatternConfig::read(ConfigReader& reader) {
  CalibrationPatternConfig config;
  Eigen::VectorXd field = config.field;
  reader.vector("field", field, Range::positive());
  config.field = field;
  reader.integer("columns", config.columns, Range::closed(2, 100));
  reader.integer("rows", config.rows, Range::closed(2, 100));
  reader.number("take_up", config.take_up, Range::positive());
  reader.number("depth", config.depth, Range::nonNegative());
  reader.number("speed", config.speed, Range::positive());
  reader.number("settle_time", config.settle_time, Range::nonNegative());
  reader.number("observation_time", config.observation_time, Range::nonNegative());
  reader.number("focus_time", config.focus_time, Range::nonNegative());
  reader.number("duration_limit", config.duration_limit, Range::positive());
  // The play is taken up between neighbours of a row.
  if (field[0] < config.take_up * (config.columns - 1)) {
    reader.error("field", "in x, neighbours of a row must be at least take_up apart");
  }
  if (field[1] < config.take_up * (config.rows - 1)) {
    reader.error("field", "in z, rows must be at least take_up apart");
  }
  if (config.depth > 0 && config.depth < config.take_up) reader.error("depth", "must be 0 or at least take_up");
  return config;
}

void CalibrationPatternConfig::validate() const {
  ConfigErrors errors("calibration pattern");
  errors.require(Range::closed(2, 100), "columns", columns);
  errors.require(Range::closed(2, 100), "rows", rows);
  for (const auto& [key, value] :
       {std::pair("take_up", take_up), {"speed", speed}, {"duration_limit", duration_limit}}) {
    errors.require(Range::positive(), key, value);
  }
  for (const auto& [key, value] : {std::pair("depth", depth),
                                   {"settle_time", settle_time},
                                   {"observation_time", observation_time},
                                   {"focus_time", focus_time}}) {
    errors.require(Range::nonNegative(), key, value);
  }
  errors.require(field[0] >= take_up * (columns - 1), "field/0", field[0], " m", "at least take_up between columns");
  errors.require(field[1] >= take_up * (rows - 1), "field/1", field[1], " m", "at least take_up between rows");
  errors.require(depth <= 0 || depth >= take_up, "depth", depth, " m", "0 or at least take_up");
  errors.throwAny();
}

CalibrationPlan planCalibration(const CalibrationPatternConfig& config, const Eigen::Vector3d& centre,
                                const Eigen::Vector3d& start, const TravelBox& box) {
  CalibrationPlan plan;
  ConfigErrors errors;
  if (!centre.allFinite() || !start.allFinite()) {
    plan.refusals.emplace_back("centre and start of the pattern: must be finite");
    return plan;
  }
  plan.waypoints = Planner(config, centre).make();
  for (const CalibrationWaypoint& each : plan.waypoints) {
    plan.observations += each.observe ? 1 : 0;
    plan.focus_readings += each.focus ? 1 : 0;
  }
  plan.duration = durationOf(config, plan.waypoints, start);
  checkInside(plan, box, errors);
  errors.require(plan.duration <= config.duration_limit, "duration", plan.duration, " s",
                 "at most " + std::to_string(config.duration_limit) + " s");
  plan.refusals = errors.messages();
  if (!errors.good()) plan.waypoints.clear();
  return plan;
}

}  // namespace microinjection
