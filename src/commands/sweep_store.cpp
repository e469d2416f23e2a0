#include "commands/sweep_store.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "commands/indent_models.h"

namespace microinjection {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char each : text) result += each == '"' ? "'" : std::string(1, each == '\n' ? ' ' : each);
  return result + "\"";
}

std::string rows(const std::string& start, const std::vector<ForcePoint>& points) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::string result;
  for (const ForcePoint& point : points) {
    const Eigen::Vector3d force = point.converged ? point.force : Eigen::Vector3d::Constant(kNan);
    char row[160];
    std::snprintf(row, sizeof row, ",%.9g,%.9g,%.9g,%.9g,%d,%.3g,", point.depth, force.x(), force.y(), force.z(),
                  point.converged ? 1 : 0, point.error_estimate);
    result += start + row + (point.reason.empty() ? "" : quoted(point.reason)) + "\n";
  }
  return result;
}

}  // namespace

std::string SweepStore::file(std::size_t task) const {
  char name[24];
  std::snprintf(name, sizeof name, "/task_%08zu", task);
  return folder_ + name;
}

CacheRead<std::string> SweepStore::load(std::size_t task) const {
  return readCacheFile(file(task), sweep_.task(task).description);
}

void SweepStore::solve(std::size_t number) const {
  const SweepFile::Task task = sweep_.task(number);
  if (readCacheFile(file(number), task.description)) return;
  std::string start = std::to_string(number);
  for (const std::string& value : sweep_.design().values(number)) start += "," + value;
  const auto ignore = [](const std::string&) {};
  writeCacheFile(file(number), task.description, rows(start, solveIndentation(task.scene, task.indentation, ignore)));
}

std::vector<std::size_t> SweepStore::missing(std::size_t first, std::size_t count) const {
  std::vector<std::size_t> result;
  for (std::size_t task = first; task < first + count; ++task) {
    const CacheRead<std::string> read = load(task);
    if (read) continue;
    if (read.state != CacheState::kMissing) std::fprintf(stderr, "sweep: %s; it is replaced\n", read.reason.c_str());
    result.push_back(task);
  }
  return result;
}

std::string SweepStore::table() const {
  std::string result = "task";
  for (const std::string& key : sweep_.keys()) result += "," + key;
  result += ",depth_m,force_x_N,force_y_N,force_z_N,converged,error_estimate,reason\n";
  std::size_t missing = 0, first = 0;
  for (std::size_t task = 0; task < sweep_.design().size(); ++task) {
    const CacheRead<std::string> read = load(task);
    if (read) {
      result += *read.content;
    } else if (missing++ == 0) {
      first = task;
    }
  }
  if (missing > 0) {
    throw ConfigError(std::to_string(missing) + " of " + std::to_string(sweep_.design().size()) +
                      " tasks are missing, the first is " + std::to_string(first));
  }
  return result;
}

}  // namespace microinjection
