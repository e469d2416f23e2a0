#include "cell/mesh/gmsh_session.h"

#include <gmsh.h>

#include <map>
#include <stdexcept>

namespace microinjection {
namespace {

std::mutex& sessionMutex() {
  static std::mutex instance;
  return instance;
}

}  // namespace

GmshSession::GmshSession() : lock_(sessionMutex()) {
  gmsh::initialize(0, nullptr, /*readConfigFiles=*/false);
  for (const auto& [name, value] : std::map<std::string, double>{{"General.Terminal", 0},
                                                                 {"General.NumThreads", 1},
                                                                 {"General.AbortOnError", 2},
                                                                 {"Mesh.RandomSeed", 1},
                                                                 {"Mesh.Algorithm", 6},
                                                                 {"Mesh.Algorithm3D", 1},
                                                                 {"Mesh.MeshSizeExtendFromBoundary", 0},
                                                                 {"Mesh.MeshSizeFromPoints", 0},
                                                                 {"Mesh.Optimize", 1},
                                                                 {"Mesh.OptimizeThreshold", 0.5}}) {
    gmsh::option::setNumber(name, value);
  }
  gmsh::model::add("cell");
}

GmshSession::~GmshSession() { gmsh::finalize(); }

void inGmshSession(const std::string& subject, const std::function<void()>& work) {
  try {
    const GmshSession session;
    work();
  } catch (const std::string& message) {  // gmsh's C++ interface throws strings
    throw std::runtime_error("gmsh could not mesh the " + subject + ": " + message);
  }
}

std::string gmshVersion() { return GMSH_API_VERSION; }

}  // namespace microinjection
