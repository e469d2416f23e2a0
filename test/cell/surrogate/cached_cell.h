#pragma once

#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "base/cache_file.h"
#include "cell/surrogate/spring_cells.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {

/// Springs with a field and a surface that moves as a whole, as can be stored.
inline SurrogateData smallCell(const Scene& scene) {
  SurrogateData cell = *fieldOfSprings(scene, 0);
  std::vector<TrainingSample> samples;
  for (int i = 1; i <= 6; ++i) {
    const Eigen::Vector3d way(0.1 * i * i, 0.3 * (i % 3), -1.0 * i);
    const Eigen::VectorXf surface =
        Eigen::VectorXf::LinSpaced(3 * SurfaceGrid::standard().nodeCount(), 1e-6f * i, 2e-6f * i * i);
    samples.push_back({0.1 * i, 1e-6 * way, way, surface});
  }
  cell.surface = SurfaceShape(cell.range, scene.radius(), {0.0, 0.5}, samples);
  return cell;
}

/// Stores a file of a cache again, with the same description, its body changed and the checksum right.
inline void changeBody(const std::string& path, const std::function<void(std::string& body)>& change) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string whole = text.str();
  const std::size_t end = whole.find('\n');
  std::string body = whole.substr(end + 1);
  change(body);
  const std::string first = whole.substr(0, end);
  writeCacheFile(path, first.substr(0, first.rfind(" checksum ")), body);
}

/// Overwrites the bytes at `offset`.
template <typename T>
void overwrite(std::string& body, std::size_t offset, T value) {
  body.replace(offset, sizeof(T), reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace microinjection
