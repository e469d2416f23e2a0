#include "cell/mesh/mesh_cache.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <stdexcept>

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

template <typename T>
void append(std::string& bytes, const T* data, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(data), count * sizeof(T));
}

std::string encodeBody(const TetMesh& mesh) {
  std::string body;
  const std::uint64_t counts[2] = {mesh.vertices.size(), mesh.tetrahedra.size()};
  append(body, counts, 2);
  for (const Eigen::Vector3d& vertex : mesh.vertices) append(body, vertex.data(), 3);
  for (const std::array<int, 4>& tetrahedron : mesh.tetrahedra) append(body, tetrahedron.data(), 4);
  append(body, mesh.layers.data(), mesh.layers.size());
  return body;
}

template <typename T>
const char* readArray(const char* bytes, std::vector<T>& values, std::uint64_t count) {
  values.resize(count);
  std::memcpy(static_cast<void*>(values.data()), bytes, count * sizeof(T));
  return bytes + count * sizeof(T);
}

/// Returns nothing when the sizes do not fit the number of bytes.
std::optional<TetMesh> decodeBody(const std::string& body) {
  std::uint64_t counts[2];
  if (body.size() < sizeof(counts)) return std::nullopt;
  std::memcpy(counts, body.data(), sizeof(counts));
  constexpr std::size_t kVertex = sizeof(Eigen::Vector3d), kTetrahedron = sizeof(std::array<int, 4>) + sizeof(int);
  const std::size_t rest = body.size() - sizeof(counts);
  // Division, because the product may overflow with the counts of a damaged file.
  if (counts[0] > rest / kVertex || counts[1] > rest / kTetrahedron) return std::nullopt;
  if (counts[0] * kVertex + counts[1] * kTetrahedron != rest) return std::nullopt;
  TetMesh mesh;
  const char* bytes = readArray(body.data() + sizeof(counts), mesh.vertices, counts[0]);
  bytes = readArray(bytes, mesh.tetrahedra, counts[1]);
  readArray(bytes, mesh.layers, counts[1]);
  return mesh;
}

std::optional<TetMesh> readMesh(const std::string& path, const std::string& description) {
  const CacheRead<std::string> read = readCacheFile(path, description);
  return read ? decodeBody(*read.content) : std::nullopt;
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
    if (!file.empty()) writeCacheFile(file, description, encodeBody(mesh));
  } catch (const std::runtime_error&) {
    // A mesh that is not stored only costs time.
  }
  return mesh;
}

}  // namespace microinjection
