#include "benchmark/common/surrogate_scene.h"

#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "base/worker_processes.h"

namespace microinjection {

SurrogateData surrogateScene(const Scene& scene, const std::string& scene_file) {
  const SurrogateRange range = SurrogateRange::standard(scene);
  const std::string path = surrogateFile(scene, SurrogatePlan::plan(scene, range));
  if (auto cell = SurrogateData::load(scene, range, path)) return *cell.content;
  std::cerr << "not prepared yet: running prepare --scene " << scene_file << " (minutes, once)\n";
  const std::string program = std::filesystem::path(thisProgram()).parent_path().string() + "/prepare";
  runWorkers({{program, "--scene", scene_file}}, 1, [](std::size_t, int status) {
    if (status != 0) throw std::runtime_error("prepare failed");
  });
  const auto cell = SurrogateData::load(scene, range, path);
  if (!cell) throw std::runtime_error("prepare left no data: " + cell.reason);
  return *cell.content;
}

}  // namespace microinjection
