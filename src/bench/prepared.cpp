// The prepared cell (off-line stage) against the converging model where it was not trained, and its time.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/worker_processes.h"
#include "bench/bench_main.h"
#include "bench/common/forked_case.h"
#include "surrogate/prepared_contact.h"
#include "surrogate/training_ray.h"

namespace microinjection {
namespace {

constexpr double kLevel = -0.5;  ///< of the reference: finer than the training's
constexpr int kPaths = 10;
constexpr int kPoints = 4;  ///< along each
constexpr unsigned kTimeLimit = 600;
constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";

double cpuTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

PreparedCell prepared(const Scene& scene) {
  const PreparationRange range = PreparationRange::standard(scene);
  const std::string path = preparedFile(scene, Preparation::plan(scene, range));
  const std::string program = std::filesystem::path(thisProgram()).parent_path().string() + "/prepare";
  if (auto cell = PreparedCell::load(scene, range, path)) return *cell;
  runWorkers({{program, "--scene", kScene}}, 1, [](std::size_t, int status) {
    if (status != 0) throw std::runtime_error("prepare failed");
  });
  if (auto cell = PreparedCell::load(scene, range, path)) return *cell;
  throw std::runtime_error("prepare left no data in " + path);
}

/// Paths to random places in the range; the needle's place lies between the trained angles as often as on them.
std::vector<TrainingRay> unseenPaths(const PreparationRange& range) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<TrainingRay> paths;
  for (int i = 0; i < kPaths; ++i) {
    const double side = range.lateral * std::sqrt(share(random)), turn = M_PI * share(random);
    const double depth = range.depth * (0.25 + 0.75 * share(random));
    paths.push_back(
        {range.angle * (i + 0.5) / kPaths, {side * std::cos(turn), side * std::sin(turn), -depth}, kPoints});
  }
  return paths;
}

std::string row(const PreparedCell& cell, const TrainingSample& sample, const Eigen::VectorXd& displaced) {
  EnergyExpansion::Local local;
  cell.energy.makeLocal(sample.angle, local);
  const Eigen::Vector3d force = -local.evaluate(sample.displacement).gradient, u = sample.displacement;
  char text[300];
  std::snprintf(text, sizeof(text), "%.1f,%.4g,%.4g,%.4g,%.5g,%.5g,%.4f,%.3g\n", sample.angle * 180 / M_PI, u.x(),
                u.y(), -u.z(), force.norm(), sample.force.norm(), (force - sample.force).norm() / sample.force.norm(),
                displaced.size() > 0 ? displaced.norm() / std::sqrt(displaced.size() / 3.0) : NAN);
  return text;
}

/// Difference of the surfaces, m: nodes of another mesh do not correspond, so the reference is solved on the
/// training's.
Eigen::VectorXd surfaceError(const PreparedCell& cell, const TrainingSample& on_training_mesh) {
  Eigen::VectorXd rest, displaced;
  cell.surface.evaluate(on_training_mesh.angle, on_training_mesh.displacement, rest, displaced);
  return displaced - on_training_mesh.surface.cast<double>();
}

std::string solvePath(const Scene& scene, const PreparedCell& cell, const TrainingRay& ray) {
  const TrainingResult fine = solveRay(scene, ray, kLevel), coarse = solveRay(scene, ray, kTrainingLevel);
  std::string rows;
  for (std::size_t i = 0; i < fine.samples.size(); ++i) {
    Eigen::VectorXd difference;
    if (i < coarse.samples.size()) difference = surfaceError(cell, coarse.samples[i]);
    rows += row(cell, fine.samples[i], difference);
  }
  if (!fine.reason.empty()) std::cerr << "prepared: a reference path ended: " << fine.reason << '\n';
  return rows;
}

void reportTimes(const Scene& scene, std::shared_ptr<const PreparedCell> cell) {
  PreparedContact contact(scene, cell);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1, 1);
  std::vector<double> times;
  double sum = 0;
  for (int i = 0; i < 200000; ++i) {  // in and out, on random places
    const double height = 28e-6 - 10e-6 * (1 + std::sin(0.01 * i)) + 0.5e-6;
    if (i % 1000 == 0) contact.reset();
    const Eigen::Vector3d tip(10e-6 * noise(random) * 0.05, 2e-6 * noise(random), height);
    const double start = cpuTime();
    sum += contact.step(tip).force.z();
    times.push_back(1e6 * (cpuTime() - start));
  }
  std::sort(times.begin(), times.end());
  std::fprintf(stderr, "prepared: force and stiffness: median %.2f us, p99 %.2f us of CPU (mean force %.3g N)\n",
               times[times.size() / 2], times[times.size() * 99 / 100], sum / 200000);
  Eigen::Matrix3Xd rest, displaced;
  const double start = cpuTime();
  for (int i = 0; i < 100; ++i) contact.surface(rest, displaced);
  std::fprintf(stderr, "prepared: surface of %d nodes: %.3f ms of CPU\n", cell->surface.nodeCount(),
               10 * (cpuTime() - start));
}

std::string table() {
  const Scene scene = loadScene(kScene);
  const auto cell = std::make_shared<const PreparedCell>(prepared(scene));
  reportTimes(scene, cell);
  std::string text = "angle_deg,lateral_x_m,lateral_y_m,depth_m,force_N,reference_N,error,surface_rms_m\n";
  std::cout << text;
  for (const TrainingRay& ray : unseenPaths(cell->range)) {
    const ForkedCase outcome = runForked([&] { return solvePath(scene, *cell, ray); }, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << "prepared: a path failed: " << outcome.failure << '\n';
    std::cout << outcome.output << std::flush;
    text += outcome.output;
  }
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "prepared: the prepared cell's force and surface where it was not trained, and its time",
      microinjection::table);
}
