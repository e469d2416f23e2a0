#pragma once

#include <string>

#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Meshes on disk, each in a file named after the hash of the configuration and mesherVersion(). A
/// file that is truncated, damaged or of another mesh is replaced.
class MeshCache {
 public:
  /// Stores in `directory`; an empty one disables the cache.
  explicit MeshCache(std::string directory = defaultDirectory());

  /// cell_microinjection/meshes in $XDG_CACHE_HOME or else ~/.cache; empty when neither variable is
  /// set.
  static std::string defaultDirectory();

  /// The mesh, from the disk or from makeCellMesh, with its exceptions. A mesh that cannot be
  /// stored (a full or read-only disk) is returned, too.
  TetMesh get(const CellMeshConfig& config) const;

  /// The file of a configuration; empty when the cache is disabled.
  std::string path(const CellMeshConfig& config) const;

 private:
  std::string directory_;
};

}  // namespace microinjection
