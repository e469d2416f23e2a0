#include "cell/mesh/mesh_cache.h"

#include <optional>
#include <sstream>
#include <stdexcept>

#include "base/bytes.h"
#include "base/cache_file.h"

namespace microinjection {
namespace {

/// Exact text of everything that determines a mesh.
std::string describe(const CellMeshConfig& config) {
  std::ostringstream out;
  out << mesherVersion() << std::hexfloat << " size " << config.size << " growth " << config.growth << " radii";
  for (double radius : config.radii) out << ' ' << radius;
  if (config.stretch != 1) out << " stretch " << config.stretch;
  for (const auto& [shape, centre, radius, side, size] : config.refinements) {
    out << (shape == CellMeshConfig::Shape::kBall ? " ball " : " circle ") << centre.x() << ' ' << centre.y() << ' '
        << radius << ' ' << side << ' ' << size;
  }
  for (const auto& [centre, radius, side] : config.imprints) {
    out << " imprint " << centre.x() << ' ' << centre.y() << ' ' << radius << ' ' << side;
  }
  return out.str();
}

std::optional<TetMesh> readMesh(const std::string& path, const std::string& description) {
  const CacheRead<std::string> read = readCacheFile(path, description);
  if (!read) return std::nullopt;
  try {
    ByteReader reader(*read.content);
    TetMesh mesh;
    reader.array(mesh.vertices);
    reader.array(mesh.tetrahedra);
    reader.array(mesh.layers);
    if (reader.atEnd() && mesh.layers.size() == mesh.tetrahedra.size()) return mesh;
  } catch (const std::runtime_error&) {
    // The sizes do not fit the number of bytes.
  }
  return std::nullopt;
}

}  // namespace

MeshCache::MeshCache(std::string directory) : directory_(std::move(directory)) {}

std::string MeshCache::defaultDirectory() { return cacheDirectory("meshes"); }

std::string MeshCache::path(const CellMeshConfig& config) const {
  return directory_.empty() ? "" : directory_ + "/" + contentHash(describe(config)) + ".mesh";
}

TetMesh MeshCache::get(const CellMeshConfig& config) const {
  const std::string file = path(config), description = describe(config);
  if (!file.empty()) {
    if (std::optional<TetMesh> mesh = readMesh(file, description)) return *mesh;
  }
  TetMesh mesh = makeCellMesh(config);
  try {
    ByteWriter body;
    body.array(mesh.vertices);
    body.array(mesh.tetrahedra);
    body.array(mesh.layers);
    if (!file.empty()) writeCacheFile(file, description, body.bytes());
  } catch (const std::runtime_error&) {
    // A mesh that is not stored only costs time.
  }
  return mesh;
}

}  // namespace microinjection
