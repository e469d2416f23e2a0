#include "commands/axis_store.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/bytes.h"
#include "base/errors.h"
#include "cell/family/axis_force.h"

namespace microinjection {

AxisStore::AxisStore(const Family& family) : family_(family) {
  const std::string cache = cacheDirectory("prepared");
  if (cache.empty()) throw ConfigError("neither XDG_CACHE_HOME nor HOME is set: no folder for the data");
  folder_ = cache + "/" + contentHash(family.description() + " axis");
}

std::string AxisStore::description(int node) const {
  return family_.description() + " axis node " + std::to_string(node);
}

std::string AxisStore::file(int node) const { return folder_ + "/axis_" + std::to_string(node); }

CacheRead<double> AxisStore::load(int node) const {
  const CacheRead<std::string> read = readCacheFile(file(node), description(node));
  if (!read) return read.failure<double>();
  ByteReader reader(*read.content);
  return {reader.number<double>(), CacheState::kRead, ""};
}

std::vector<int> AxisStore::missing() const {
  std::vector<int> result;
  for (int node = 0; node < axisForceGrid(family_).size(); ++node) {
    if (!load(node)) result.push_back(node);
  }
  return result;
}

void AxisStore::solve(int node) const {
  double force = std::numeric_limits<double>::quiet_NaN();
  try {
    force = solveAxisForce(family_, axisForceGrid(family_).node(node));
  } catch (const std::runtime_error&) {
  }
  requireWritableFolder(folder_);
  ByteWriter writer;
  writer.number(force);
  writeCacheFile(file(node), description(node), writer.bytes());
}

Eigen::VectorXd AxisStore::loadAll() const {
  Eigen::VectorXd forces(axisForceGrid(family_).size());
  for (int node = 0; node < forces.size(); ++node) {
    const CacheRead<double> read = load(node);
    if (!read) throw std::runtime_error(read.reason);
    forces[node] = *read.content;
  }
  if (!forces.allFinite() || !(forces.minCoeff() > 0)) return {};
  return forces;
}

}  // namespace microinjection
