#include "cell/identification/force_curve.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>

#include "base/errors.h"
#include "base/median.h"
#include "base/text_table.h"
#include "cell/identification/drag.h"
#include "cell/identification/other_rows.h"
#include "cell/identification/record_columns.h"
#include "cell/identification/way_in.h"

namespace microinjection {
namespace {

constexpr std::size_t kFewestSamples = 20;  ///< samples
constexpr double kNear = 0.15;              ///< of the way, to the end of a record
constexpr double kClearly = 5;              ///< times the spread of the force at the other end
constexpr double kBent = 0.1;               ///< of its rise: a straighter record is in contact from its begin

/// The positions; one that is farther from its neighbours' median than any step is no place of the tip, and
/// the median stands for it.
std::vector<double> withoutSpikes(const std::vector<double>& values) {
  constexpr std::size_t kBeside = 2;
  constexpr double kSpike = 3;  ///< steps
  std::vector<double> medians;
  double step = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t from = i < kBeside ? 0 : i - kBeside, to = std::min(values.size(), i + kBeside + 1);
    medians.push_back(upperMedian({values.data() + from, values.data() + to}));
    if (i > 0) step = std::max(step, std::abs(medians[i] - medians[i - 1]));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(values[i] - medians[i]) <= kSpike * step) medians[i] = values[i];
  }
  return medians;
}

/// Value at the deepest samples minus that of the straight line through those of the first half, which is
/// a drift; for a straight record, its whole rise.
double rise(const ForceCurve& curve, const std::vector<double>& values) {
  const std::vector<double> path = withoutSpikes(curve.position);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return path[a] < path[b]; });
  const std::size_t quarter = std::max<std::size_t>(2, order.size() / 4),
                    few = std::max<std::size_t>(2, order.size() / 50);
  const auto middle = [&](const std::vector<double>& of, std::size_t from, std::size_t count) {
    std::vector<double> part;
    for (std::size_t i = from; i < from + count; ++i) part.push_back(of[order[i]]);
    return upperMedian(part);
  };
  const double x0 = middle(path, 0, quarter), x1 = middle(path, quarter, quarter),
               x2 = middle(path, order.size() - few, few);
  const double y0 = middle(values, 0, quarter), y1 = middle(values, quarter, quarter),
               y2 = middle(values, order.size() - few, few);
  const double slope = x1 > x0 ? (y1 - y0) / (x1 - x0) : 0;
  const double beyond = y2 - y0 - slope * (x2 - x0);
  return std::abs(beyond) > kBent * std::abs(y2 - y0) ? beyond : y2 - y0;
}

/// The height grows towards the cell.
void orient(ForceCurve& curve) {
  const std::vector<double> path = withoutSpikes(curve.position);
  const auto farthest = std::max_element(
      path.begin(), path.end(), [&](double a, double b) { return std::abs(a - path[0]) < std::abs(b - path[0]); });
  // A record may begin in the cell, with the way out: there the force changes with the place.
  const double way = *farthest - path[0];
  const auto spread_near = [&](double place) {
    std::vector<double> forces;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (std::abs(path[i] - place) <= kNear * std::abs(way)) forces.push_back(curve.force[i]);
    }
    std::sort(forces.begin(), forces.end());
    return forces.empty() ? 0 : forces[forces.size() * 19 / 20] - forces[forces.size() / 20];
  };
  const bool begins_in_cell = spread_near(path[0]) > kClearly * spread_near(*farthest);
  if ((*farthest < path[0]) != begins_in_cell) {
    for (double& x : curve.position) x = -x;
    curve.notes.emplace_back("the position falls on the way in: its sign is turned");
  }
}

void orientForce(ForceCurve& curve) {
  if (rise(curve, curve.force) >= 0) return;
  for (double& x : curve.force) x = -x;
  curve.notes.emplace_back("the force falls on the way in: its sign is turned");
}

void keep(ForceCurve& curve, std::size_t begin, std::size_t end) {
  for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force}) {
    values->resize(end);
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(begin));
  }
}

void keepOnly(ForceCurve& curve, const std::vector<bool>& kept) {
  for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force}) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (kept[i]) (*values)[count++] = (*values)[i];
    }
    values->resize(count);
  }
}

/// Only the way in is elastic.
void cutToWayIn(ForceCurve& curve) {
  const WayIn way = findWayIn(curve.time, withoutSpikes(curve.position));
  curve.notes.insert(curve.notes.end(), way.notes.begin(), way.notes.end());
  keep(curve, way.begin, way.end);
}

void cutAtPuncture(ForceCurve& curve) {
  const auto crest = crestBeforePuncture(curve.position, curve.force);
  if (!crest) return;
  curve.notes.push_back("the force breaks down " + std::to_string(curve.size() - *crest - 1) +
                        " samples before the end, as in a puncture: these are left out");
  keep(curve, 0, *crest + 1);
}

void cutHeldForce(ForceCurve& curve) {
  const std::size_t end = endOfLoading(curve.time, curve.force);
  if (end == curve.size()) return;
  curve.notes.push_back("the last " + std::to_string(curve.size() - end) +
                        " samples are left out: the force is held, and the tip creeps");
  keep(curve, 0, end);
}

/// Whether the position is that of a lever's base. Throws ConfigError where it cannot be known.
bool isOfBase(const TextTable& table, const RecordColumn& position, bool has_deflection, const ForceCurveConfig& config,
              std::vector<std::string>& notes) {
  const std::string column = "column '" + table.titles()[position.index] + "'";
  const auto is_any = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return position.name == name; });
  };
  const bool bends = has_deflection || config.spring_constant > 0;
  if (config.position_of == "base" && !bends)
    throw ConfigError(
        table.path + ": " + column +
        " is that of the lever's base: --position-of base needs a column of the deflection, or --spring-constant");
  if (config.position_of != "auto") return config.position_of == "base";
  if (is_any({"tip", "tip_z", "depth", "indentation"})) {
    if (bends)
      notes.push_back(column + " is the tip's: no deflection is taken off it (--position-of base takes it off)");
    return false;
  }
  if (is_any({"height", "z"})) {
    if (!bends)
      notes.push_back(column +
                      " is taken for the tip's position; if it is that of a lever's base, give --spring-constant");
    return true;
  }
  if (bends)
    throw ConfigError(table.path + ": " + column +
                      ": is it the tip's, or that of the lever's base, off which the deflection is taken? Give "
                      "--position-of tip or --position-of base");
  return false;
}

}  // namespace

ForceCurve readForceCurve(const std::string& path, const ForceCurveConfig& config) {
  const TextTable table = readTextTable(path);
  ForceCurve curve;
  curve.notes = table.notes;
  const std::map<std::string, RecordColumn> columns =
      findRecordColumns(table, RecordKind::kForce, config.columns, curve.notes);
  const auto valueOf = [&](const char* quantity, std::size_t row, double otherwise) {
    const auto found = columns.find(quantity);
    return found == columns.end() ? otherwise : found->second.unit * table.columns[found->second.index].values[row];
  };
  curve.timed = columns.count("time") > 0;
  std::vector<double> deflections;
  std::vector<bool> of_way;
  OtherRows others(table, config);
  const bool has_deflection = columns.count("deflection") > 0;
  const bool of_base = isOfBase(table, columns.at("position"), has_deflection, config, curve.notes);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double height = valueOf("position", row, 0), force = valueOf("force", row, 0);
    const double bent = has_deflection || config.spring_constant == 0 ? 0 : force / config.spring_constant;
    const double deflection = of_base ? valueOf("deflection", row, bent) : 0;
    const double time = valueOf("time", row, static_cast<double>(curve.size()));
    if (!std::isfinite(height + force + deflection + time)) continue;
    curve.time.push_back(time);
    curve.position.push_back(height);
    deflections.push_back(deflection);
    curve.force.push_back(force);
    of_way.push_back(!others.has(row, time));
  }
  const std::size_t dropped = table.rows() - curve.size();
  if (dropped > 0) {
    std::string text;
    for (const auto& [quantity, column] : columns) {
      const TextTable::Column& found = table.columns[column.index];
      if (!found.text.empty()) text = ", as that with '" + found.text + "' in line " + std::to_string(found.text_line);
    }
    curve.notes.push_back(std::to_string(dropped) + " rows without numbers are left out" + text);
  }
  if (curve.size() < kFewestSamples) {
    throw ConfigError(path + ": " + std::to_string(curve.size()) + " rows have a number in each column that is used, " +
                      std::to_string(dropped) + " have not: must be at least " + std::to_string(kFewestSamples));
  }
  if (!curve.timed) curve.notes.emplace_back("there is no column of the time: a drift is one a sample");
  orient(curve);
  // The lever bends away from the cell: the tip goes less far than its base.
  const double sign = rise(curve, deflections) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < curve.size(); ++i) curve.position[i] -= sign * deflections[i];
  curve.drag = dragOf(curve);
  others.tell(curve.notes);
  keepOnly(curve, of_way);
  if (!config.whole) cutToWayIn(curve);
  if (curve.size() < kFewestSamples) throw ConfigError(path + ": has no way in: its first samples are its deepest");
  orientForce(curve);
  if (!config.whole) {
    cutAtPuncture(curve);
    cutHeldForce(curve);
  }
  if (curve.size() < kFewestSamples)
    throw ConfigError(path + ": has " + std::to_string(curve.size()) +
                      " samples before the force breaks down: must be at least " + std::to_string(kFewestSamples));
  return curve;
}

ForceCurve averaged(const ForceCurve& curve, std::size_t count) {
  const std::size_t block = (curve.size() + count - 1) / count;
  if (block <= 1) return curve;
  ForceCurve result;
  result.timed = curve.timed;
  result.drag = curve.drag;
  result.notes = curve.notes;
  const auto mean = [&](const std::vector<double>& values, std::size_t from) {
    double sum = 0;
    for (std::size_t i = from; i < from + block; ++i) sum += values[i];
    return sum / static_cast<double>(block);
  };
  for (std::size_t from = 0; from + block <= curve.size(); from += block) {
    result.time.push_back(mean(curve.time, from));
    result.position.push_back(mean(curve.position, from));
    result.force.push_back(mean(curve.force, from));
  }
  return result;
}

}  // namespace microinjection
