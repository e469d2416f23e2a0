#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/family/family.h"

namespace microinjection {

/// A family's curves of the force on the axis (axisForceGrid()), a file each in the folder of the family.
class AxisStore {
 public:
  /// Throws ConfigError without a cache.
  explicit AxisStore(const Family& family);

  const std::string& folder() const { return folder_; }
  /// Nodes without a usable file.
  std::vector<int> missing() const;
  /// Solves and stores a node.
  void solve(int node) const;
  /// Of all nodes (rows); empty when some have no solution. Throws std::runtime_error when one is missing.
  Eigen::MatrixXd loadAll() const;

 private:
  std::string description(int node) const;
  std::string file(int node) const;
  CacheRead<Eigen::VectorXd> load(int node) const;  ///< empty: no solution

  Family family_;
  std::string folder_;
};

}  // namespace microinjection
