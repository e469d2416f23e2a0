#include "commands/axis_store.h"

#include <stdexcept>

#include "base/atomic_file.h"
#include "base/bytes.h"
#include "base/errors.h"
#include "cell/family/axis_force.h"

namespace microinjection {

AxisStore::AxisStore(const Family& family) : family_(family) {
  const std::string cache = cacheDirectory("surrogates");
  if (cache.empty()) throw ConfigError("neither XDG_CACHE_HOME nor HOME is set: no folder for the data");
  folder_ = cache + "/" + contentHash(family.description() + " axis");
}

std::string AxisStore::description(int node) const {
  return family_.description() + " axis curve " + std::to_string(node);
}

std::string AxisStore::file(int node) const { return folder_ + "/axis_" + std::to_string(node); }

CacheRead<Eigen::VectorXd> AxisStore::load(int node) const {
  const CacheRead<std::string> read = readCacheFile(file(node), description(node));
  if (!read) return read.failure<Eigen::VectorXd>();
  ByteReader reader(*read.content);
  Eigen::VectorXd forces;
  reader.array(forces);
  return {forces, CacheState::kRead, ""};
}

std::vector<int> AxisStore::missing() const {
  std::vector<int> result;
  for (int node = 0; node < axisForceGrid(family_).size(); ++node) {
    if (!load(node)) result.push_back(node);
  }
  return result;
}

void AxisStore::solve(int node) const {
  if (load(node)) return;
  Eigen::VectorXd forces;
  try {
    forces = solveAxisForces(family_, axisForceGrid(family_).node(node));
  } catch (const std::runtime_error&) {
  }
  requireWritableFolder(folder_);
  ByteWriter writer;
  writer.array(forces);
  writeCacheFile(file(node), description(node), writer.bytes());
}

Eigen::MatrixXd AxisStore::loadAll() const {
  Eigen::MatrixXd forces(axisForceGrid(family_).size(), kAxisDepths);
  for (int node = 0; node < forces.rows(); ++node) {
    const CacheRead<Eigen::VectorXd> read = load(node);
    if (!read) throw std::runtime_error(read.reason);
    if (read.content->size() != kAxisDepths) return {};
    forces.row(node) = read.content->transpose();
  }
  if (!forces.allFinite() || !(forces.minCoeff() > 0)) return {};
  return forces;
}

}  // namespace microinjection
