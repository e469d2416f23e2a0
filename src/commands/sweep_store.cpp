#include "commands/sweep_store.h"

#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "base/errors.h"
#include "commands/indent_models.h"

namespace microinjection {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char each : text) result += each == '"' ? "'" : std::string(1, each == '\n' || each == '\r' ? ' ' : each);
  return result + "\"";
}

/// Without the task's number and its keys' values: another sweep may have the same scene by other keys.
std::string rows(const std::vector<ForcePoint>& points) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::string result;
  for (const ForcePoint& point : points) {
    const Eigen::Vector3d force = point.converged ? point.force : Eigen::Vector3d::Constant(kNan);
    char row[160];
    std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g,%.9g,%d,%.3g,", point.depth, force.x(), force.y(), force.z(),
                  point.converged ? 1 : 0, point.error_estimate);
    result += row + (point.reason.empty() ? "" : quoted(point.reason)) + "\n";
  }
  return result;
}

/// A scene that cannot be solved is a result, and the tasks after it are solved. What another machine would not meet,
/// no space or no memory, is thrown, because results must not depend on the machine.
std::vector<ForcePoint> solveOrSayWhyNot(const SweepFile::Task& task, std::size_t number) {
  const std::string name = "task " + std::to_string(number) + ": ";
  try {
    return solveIndentation(task.scene, task.indentation, [](const std::string&) {});
  } catch (const WriteError&) {
    throw;
  } catch (const std::system_error& error) {
    throw std::runtime_error(name + error.what());
  } catch (const std::bad_alloc&) {
    throw std::runtime_error(name + "there is not enough memory");
  } catch (const std::exception& error) {
    const Indenting& indenting = task.indentation.indenting;
    std::vector<ForcePoint> points(indenting.count());
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].depth = indenting.depth(i);
      points[i].reason = error.what();
    }
    return points;
  }
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
  writeCacheFile(file(number), task.description, rows(solveOrSayWhyNot(task, number)));
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
  std::string result = sweep_.columns() + ",depth_m,force_x_N,force_y_N,force_z_N,converged,error_estimate,reason\n";
  std::size_t missing = 0, first = 0;
  for (std::size_t task = 0; task < sweep_.design().size(); ++task) {
    const CacheRead<std::string> read = load(task);
    if (read) {
      std::istringstream rows(*read.content);
      for (std::string row; std::getline(rows, row);) result += sweep_.columns(task) + "," + row + "\n";
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
