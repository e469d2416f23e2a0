#pragma once

#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_plan.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// The solved paths of a preparation, a file each in the folder of its cell.
class PathStore {
 public:
  /// `scene` is without dimension. Throws ConfigError without a cache.
  PathStore(const Scene& scene, const SurrogatePlan& plan);

  const Scene& scene() const { return scene_; }
  const SurrogatePlan& plan() const { return plan_; }
  const std::string& folder() const { return folder_; }
  std::string file(std::size_t ray) const;

  CacheRead<TrainingResult> load(std::size_t ray) const;
  /// Results of all paths. Throws std::runtime_error when one is missing.
  std::vector<TrainingResult> loadAll() const;
  /// Paths without a usable file; reports damaged ones on stderr.
  std::vector<std::size_t> missing() const;

  enum class Outcome { kSolved, kBusy };
  /// Solves and stores a path, unless another process is solving it.
  Outcome solve(std::size_t ray) const;

 private:
  std::string description(std::size_t ray) const;

  Scene scene_;
  SurrogatePlan plan_;
  std::string folder_;
};

/// Reports a cache file that exists and cannot be used.
void reportDamage(CacheState state, const std::string& reason);

}  // namespace microinjection
