#include "cell/mesh/mesh_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "cell/mesh/needle_cell.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

class MeshCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(directory_);
    config_.radii = {28e-6, 14e-6};
    config_.size = 25e-6;  // quick
    config_.refinements[0].size = 12e-6;
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string read() const {
    std::ifstream file(cache_.path(config_), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  const std::string directory_ = testing::TempDir() + "microinjection_mesh_cache";
  const MeshCache cache_{directory_};
  CellMeshConfig config_ = needleCell();
};

TEST_F(MeshCacheTest, HitGivesTheIdenticalMesh) {
  const TetMesh made = cache_.get(config_);
  ASSERT_TRUE(fs::exists(cache_.path(config_)));
  const auto time = fs::last_write_time(cache_.path(config_));
  const TetMesh loaded = cache_.get(config_);
  EXPECT_EQ(made.vertices, loaded.vertices);
  EXPECT_EQ(made.tetrahedra, loaded.tetrahedra);
  EXPECT_EQ(made.layers, loaded.layers);
  EXPECT_EQ(std::set<int>(loaded.layers.begin(), loaded.layers.end()), (std::set<int>{0, 1}));
  EXPECT_EQ(fs::last_write_time(cache_.path(config_)), time) << "it was made again";
}

TEST_F(MeshCacheTest, DamagedFilesAreMadeAnew) {
  const TetMesh made = cache_.get(config_);
  const std::string good = read();
  std::string flipped = good, other_layer = good;
  flipped[good.size() / 2] ^= 1;
  other_layer[good.size() - sizeof(int)] ^= 1;  // of the last tetrahedron, on a machine that puts low bytes first
  CellMeshConfig other = config_;
  other.imprints[1].radius *= 1.1;
  cache_.get(other);
  std::ifstream foreign_file(cache_.path(other), std::ios::binary);
  const std::string foreign{std::istreambuf_iterator<char>(foreign_file), std::istreambuf_iterator<char>()};
  for (const std::string& bad : {std::string(), good.substr(0, good.size() / 2), good + "x", flipped, other_layer,
                                 foreign, std::string("no mesh at all\n")}) {
    writeFileAtomically(cache_.path(config_), bad);
    const TetMesh mesh = cache_.get(config_);
    EXPECT_EQ(mesh.vertices, made.vertices);
    EXPECT_EQ(mesh.tetrahedra, made.tetrahedra);
    EXPECT_EQ(mesh.layers, made.layers);
    EXPECT_EQ(read(), good) << "the damaged file was left";
  }
}

/// A pipe that nobody writes to would be waited for; a wrong size with a right checksum would be read beyond.
TEST_F(MeshCacheTest, WhatCannotBeAMeshIsMadeAnew) {
  const TetMesh made = cache_.get(config_);
  const std::string path = cache_.path(config_), good = read();
  const std::size_t end = good.find('\n');
  const std::string description = good.substr(0, good.rfind(" checksum ", end));
  std::string counts = good.substr(end + 1);
  counts[7] = '\x7f';  // of the vertices: more than memory
  const std::string few = good.substr(end + 1, 8), less = good.substr(end + 1, good.size() - end - 2);
  for (const std::string& body : {counts, few, less}) {
    writeCacheFile(path, description, body);
    EXPECT_EQ(cache_.get(config_).vertices, made.vertices);
    EXPECT_EQ(read(), good) << "it was left";
  }
  fs::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(cache_.get(config_).tetrahedra, made.tetrahedra);
  EXPECT_EQ(read(), good) << "it was left";
}

TEST_F(MeshCacheTest, EveryInputChangesTheFile) {
  std::set<std::string> paths = {cache_.path(config_)};
  const auto changed = [&](auto change) {
    CellMeshConfig config = config_;
    change(config);
    EXPECT_TRUE(paths.insert(cache_.path(config)).second);
  };
  const double little = 1 + 1e-12;
  changed([=](CellMeshConfig& c) { c.radii[0] *= little; });
  changed([=](CellMeshConfig& c) { c.radii[1] *= little; });
  changed([](CellMeshConfig& c) { c.radii.pop_back(); });
  changed([](CellMeshConfig& c) { c.radii.push_back(3e-6); });
  changed([=](CellMeshConfig& c) { c.size *= little; });
  changed([=](CellMeshConfig& c) { c.growth *= little; });
  changed([=](CellMeshConfig& c) { c.stretch *= little; });
  changed([](CellMeshConfig& c) { c.refinements[0].shape = CellMeshConfig::Shape::kCircle; });
  changed([](CellMeshConfig& c) { c.refinements[0].centre.x() = 1e-20; });
  changed([](CellMeshConfig& c) { c.refinements[0].centre.y() = 1e-20; });
  changed([=](CellMeshConfig& c) { c.refinements[0].radius *= little; });
  changed([](CellMeshConfig& c) { c.refinements[0].side = -1; });
  changed([=](CellMeshConfig& c) { c.refinements[0].size *= little; });
  changed([](CellMeshConfig& c) { c.refinements.push_back(c.refinements[0]); });
  changed([](CellMeshConfig& c) { c.refinements.clear(); });
  changed([](CellMeshConfig& c) { c.imprints[0].centre.x() = 1e-20; });
  changed([](CellMeshConfig& c) { c.imprints[0].centre.y() = 1e-20; });
  changed([=](CellMeshConfig& c) { c.imprints[0].radius *= little; });
  changed([=](CellMeshConfig& c) { c.imprints[1].radius *= little; });
  changed([](CellMeshConfig& c) { c.imprints[0].side = -1; });
  changed([](CellMeshConfig& c) { c.imprints.pop_back(); });
}

TEST_F(MeshCacheTest, LivesWhereTheUserKeepsCaches) {
  const auto with = [](const char* cache, const char* home) {
    const auto set = [](const char* name, const char* value) {
      value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
    };
    const std::string old_cache = std::getenv("XDG_CACHE_HOME") != nullptr ? std::getenv("XDG_CACHE_HOME") : "";
    const std::string old_home = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
    set("XDG_CACHE_HOME", cache);
    set("HOME", home);
    const std::string directory = MeshCache::defaultDirectory();
    set("XDG_CACHE_HOME", old_cache.empty() ? nullptr : old_cache.c_str());
    set("HOME", old_home.empty() ? nullptr : old_home.c_str());
    return directory;
  };
  EXPECT_EQ(with("/caches", "/home/user"), "/caches/cell_microinjection/meshes");
  EXPECT_EQ(with(nullptr, "/home/user"), "/home/user/.cache/cell_microinjection/meshes");
  EXPECT_EQ(with("relative", "/home/user"), "/home/user/.cache/cell_microinjection/meshes");
  EXPECT_EQ(with(nullptr, nullptr), "");
}

TEST_F(MeshCacheTest, WorksWithoutAPlaceToKeep) {
  EXPECT_EQ(MeshCache("").path(config_), "");
  const TetMesh made = MeshCache("").get(config_);
  fs::create_directories(directory_);
  std::ofstream(directory_ + "/file") << "x";
  const TetMesh again = MeshCache(directory_ + "/file/below").get(config_);  // cannot be written
  EXPECT_EQ(made.vertices, again.vertices);
}

}  // namespace
}  // namespace microinjection
