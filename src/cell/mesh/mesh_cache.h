#pragma once

#include <string>

#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Meshes on disk, each in a file named after the hash of everything that determines it: the whole configuration and
/// mesherVersion(). A file that is torn, damaged or made for something else is noticed and made anew.
class MeshCache {
 public:
  /// In `directory`; an empty one keeps nothing.
  explicit MeshCache(std::string directory = defaultDirectory());

  /// $XDG_CACHE_HOME or else ~/.cache, and there cell_microinjection/meshes; empty when neither variable is set.
  static std::string defaultDirectory();

  /// The mesh, from the disk or from makeCellMesh, whose exceptions it passes on. A mesh that cannot be stored (a full
  /// or read-only disk) is returned all the same.
  TetMesh get(const CellMeshConfig& config) const;

  /// The file of a configuration; empty when nothing is kept.
  std::string path(const CellMeshConfig& config) const;

 private:
  std::string directory_;
};

}  // namespace microinjection
