#include "commands/path_store.h"

#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/errors.h"
#include "base/file_lock.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

PathStore::PathStore(const Scene& scene, const SurrogatePlan& plan)
    : scene_(scene), plan_(plan), folder_(surrogateFolder(scene, plan)) {
  if (folder_.empty()) throw ConfigError("neither XDG_CACHE_HOME nor HOME is set: no folder for the data");
}

std::string PathStore::description(std::size_t ray) const { return plan_.description(scene_, plan_.rays.at(ray)); }

std::string PathStore::file(std::size_t ray) const { return folder_ + "/path_" + contentHash(description(ray)); }

CacheRead<TrainingResult> PathStore::load(std::size_t ray) const {
  return loadTraining(file(ray), description(ray), plan_.rays[ray]);
}

std::vector<TrainingResult> PathStore::loadAll() const {
  std::vector<TrainingResult> results;
  for (std::size_t i = 0; i < plan_.rays.size(); ++i) {
    CacheRead<TrainingResult> read = load(i);
    if (!read) throw std::runtime_error(read.reason);
    results.push_back(std::move(*read.content));
  }
  return results;
}

std::vector<std::size_t> PathStore::missing() const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < plan_.rays.size(); ++i) {
    const CacheRead<TrainingResult> read = load(i);
    if (read) continue;
    reportDamage(read.state, read.reason);
    result.push_back(i);
  }
  return result;
}

PathStore::Outcome PathStore::solve(std::size_t ray) const {
  requireWritableFolder(folder_);
  const auto piece = static_cast<std::uint32_t>(std::stoull(contentHash(description(ray)), nullptr, 16) >> 33);
  const FileLock lock(folder_ + "/lock", piece);
  if (!lock.held()) return Outcome::kBusy;
  if (load(ray)) return Outcome::kSolved;  // by the process that had the lock
  writeCacheFile(file(ray), description(ray), encode(solveRay(scene_, plan_.rays[ray])));
  return Outcome::kSolved;
}

void reportDamage(CacheState state, const std::string& reason) {
  if (state == CacheState::kRead || state == CacheState::kMissing) return;
  std::fprintf(stderr, "prepare: %s; it is replaced\n", reason.c_str());
}

}  // namespace microinjection
