// The surrogate cell against the converging model where it was not trained, and its time.

#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/cpu_time.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/forked_case.h"
#include "benchmark/common/surrogate_scene.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/surface_grid.h"
#include "cell/surrogate/surrogate_cell_model.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {
namespace {

constexpr double kLevel = 0;  ///< of the reference: two steps finer than the training's
constexpr int kPaths = 8;
constexpr int kPoints = 4;  ///< along each
constexpr unsigned kTimeLimit = 1200;
constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";

/// The scene with another Poisson ratio, in a file of its own.
std::string sceneFile(double poisson_ratio) {
  YAML::Node scene = YAML::LoadFile(kScene);
  if (scene["cell"]["material"]["poisson_ratio"].as<double>() == poisson_ratio) return kScene;
  scene["cell"]["material"]["poisson_ratio"] = poisson_ratio;
  const std::string path =
      std::filesystem::temp_directory_path() / ("prepared_" + std::to_string(poisson_ratio) + ".yaml");
  std::ostringstream text;
  text << scene << '\n';
  writeFileAtomically(path, text.str());
  return path;
}

/// Paths to random places in the range, between the trained angles; every second one in the plane
/// of symmetry.
std::vector<TrainingRay> unseenPaths(const SurrogateRange& range) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<TrainingRay> paths;
  for (int i = 0; i < kPaths; ++i) {
    const double side = range.lateral * std::sqrt(share(random)), any = M_PI * share(random);
    const double depth = range.depth * (0.25 + 0.75 * share(random));
    const double away = i % 2 == 0 ? std::cos(any) : any < M_PI / 2 ? 1 : -1, across = i % 2 == 0 ? std::sin(any) : 0;
    paths.push_back({range.angle * (i + 0.5) / kPaths, {side * away, side * across, -depth}, kPoints});
  }
  return paths;
}

/// Random closed paths in and out of the cell and of the range: largest share of the energy that
/// went to and fro which the needle got for nothing (negative: it lost some).
double createdEnergy(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell) {
  constexpr int kClosed = 200, kLegs = 6, kSteps = 2000;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1, 1);
  SurrogateContact contact(scene, cell);
  const double radius = scene.radius(), top = radius + 2 * scene.needle.tip.radius;
  double worst = -1;
  for (int path = 0; path < kClosed; ++path) {
    const Eigen::Vector3d start(0.6 * radius * share(random), 0.6 * radius * share(random), top);
    Eigen::Vector3d tip = start, force = Eigen::Vector3d::Zero();
    double work = 0, exchanged = 0;
    for (int leg = 0; leg <= kLegs; ++leg) {
      const double depth = 0.5 * (1 + share(random)) * radius;
      Eigen::Vector3d target = start + 0.25 * radius * Eigen::Vector3d(share(random), share(random), 0);
      target.z() -= depth + top - radius;
      if (leg == kLegs) target = start;
      const Eigen::Vector3d move = (target - tip) / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        tip += move;
        const Eigen::Vector3d now = contact.step(tip).force;
        const double bit = 0.5 * (force + now).dot(move);
        work += bit;
        exchanged += std::abs(bit);
        force = now;
      }
    }
    if (exchanged > 0) worst = std::max(worst, work / exchanged);
  }
  return worst;
}

std::string row(const SurrogateData& cell, const TrainingSample& sample, const Eigen::VectorXd& displaced) {
  ForceField::Local local;
  cell.field.makeLocal(sample.angle, local);
  Eigen::Matrix3d jacobian;
  const Eigen::Vector3d u = sample.displacement, force = local.evaluate(u, jacobian);
  char text[300];
  std::snprintf(text, sizeof(text), "%.1f,%.4g,%.4g,%.4g,%.5g,%.5g,%.4f,%.3g\n", sample.angle * 180 / M_PI, u.x(),
                u.y(), -u.z(), force.norm(), sample.force.norm(), (force - sample.force).norm() / sample.force.norm(),
                displaced.size() > 0 ? displaced.norm() / std::sqrt(displaced.size() / 3.0) : NAN);
  return text;
}

/// Difference of the surfaces, m: nodes of another mesh do not correspond, so the reference is
/// solved on the training's.
Eigen::VectorXd surfaceError(const SurrogateData& cell, const TrainingSample& on_training_mesh) {
  Eigen::VectorXd rest, displaced;
  cell.surface.evaluate(on_training_mesh.angle, on_training_mesh.displacement, rest, displaced);
  return displaced - on_training_mesh.surface.cast<double>();
}

std::string solvePath(const Scene& scene, const SurrogateData& cell, const TrainingRay& ray) {
  TrainingRay fine_ray = ray;
  fine_ray.level = kLevel;
  const TrainingResult fine = solveRay(scene, fine_ray), coarse = solveRay(scene, ray);
  std::string rows;
  for (std::size_t i = 0; i < fine.samples.size(); ++i) {
    Eigen::VectorXd difference;
    if (i < coarse.samples.size()) difference = surfaceError(cell, coarse.samples[i]);
    rows += row(cell, fine.samples[i], difference);
  }
  if (!fine.reason.empty()) std::cerr << "surrogate: a reference path ended: " << fine.reason << '\n';
  return rows;
}

void reportTimes(const Scene& scene, std::shared_ptr<const SurrogateData> cell) {
  SurrogateContact contact(scene, cell);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1, 1);
  std::vector<double> times;
  double sum = 0;
  for (int i = 0; i < 200000; ++i) {  // in and out, on random places
    const double height = 28e-6 - 10e-6 * (1 + std::sin(0.01 * i)) + 0.5e-6;
    if (i % 1000 == 0) contact.reset();
    const Eigen::Vector3d tip(10e-6 * noise(random) * 0.05, 2e-6 * noise(random), height);
    const double start = threadCpuTime();
    sum += contact.step(tip).force.z();
    times.push_back(1e6 * (threadCpuTime() - start));
  }
  std::sort(times.begin(), times.end());
  std::fprintf(stderr, "surrogate: force and stiffness: median %.2f us, p99 %.2f us of CPU (mean force %.3g N)\n",
               times[times.size() / 2], times[times.size() * 99 / 100], sum / 200000);
  Eigen::Matrix3Xd rest, displaced;
  const double start = threadCpuTime();
  for (int i = 0; i < 100; ++i) SurrogateContact::surface(*cell, contact.shape(), rest, displaced);
  std::fprintf(stderr, "surrogate: surface of %d nodes: %.3f ms of CPU\n", SurfaceGrid::standard().nodeCount(),
               10 * (threadCpuTime() - start));
}

/// Where points stick as they touch, the force depends on the way: straight to a place against down
/// and then aside, on the training's mesh.
std::string pathDependence(const Scene& scene, double angle_deg, const Eigen::Vector3d& end) {
  Scene there = scene;
  there.needle.offset = ContactFrame::offsetFor(scene, angle_deg * M_PI / 180);
  CellProblem<3> straight(there, makeSceneMesh<3>(there, kCoarseLevel), ElementKind::kP2P0);
  CellProblem<3> bent(there, makeSceneMesh<3>(there, kCoarseLevel), ElementKind::kP2P0);
  const Eigen::Vector3d force = straight.solve(end).force;
  bent.solve({0, 0, end.z()});
  char text[160];
  std::snprintf(text, sizeof(text),
                "surrogate: at %.0f degrees, %.0f um aside and %.0f um deep, the way there matters by %.2g %%\n",
                angle_deg, 1e6 * end.head<2>().norm(), -1e6 * end.z(),
                100 * (bent.solve(end).force - force).norm() / force.norm());
  return text;
}

/// With Prony terms, at constant speed on the axis, against the section in which the material
/// itself relaxes.
std::string memoryError(Scene scene, const std::shared_ptr<const SurrogateData>& cell, double speed) {
  scene.cell.material().viscoelasticity.prony = {{0.5, 0.2}, {0.3, 2}};
  SurrogateCellModel tracker(scene, cell);
  CellProblem<2> section(scene, makeSceneMesh<2>(scene, 0), ElementKind::kP2P0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::string text;
  double depth = 0, time = 0;
  for (const double target : {1e-6, 2e-6, 5e-6, 10e-6, 15e-6}) {
    constexpr int kSteps = 1000;
    const double duration = (target - depth) / speed;
    TipForce force;
    for (int i = 1; i <= kSteps; ++i) {
      const double there = depth + (target - depth) * i / kSteps;
      force = tracker.step((scene.radius() - there) * up, up, time + duration * i / kSteps);
    }
    time += duration;
    depth = target;
    const double full = section.solve(-depth * up, duration).force.z();
    char part[80];
    std::snprintf(part, sizeof(part), " %+.1f %% at %.0f um", 100 * (force.force.z() / full - 1), 1e6 * depth);
    text += part;
  }
  char head[80];
  std::snprintf(head, sizeof(head), "surrogate: relaxing cell at %.0f um/s:", 1e6 * speed);
  return head + text + '\n';
}

void summarise(const std::string& table) {
  std::vector<double> errors;
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; column < 7; ++column) std::getline(cells, cell, ',');
    errors.push_back(std::stod(cell));
  }
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  std::fprintf(stderr,
               "surrogate: force error at %zu unseen places: median %.2g %%, nine of ten below %.2g %%, largest "
               "%.2g %%\n",
               errors.size(), 100 * errors[errors.size() / 2], 100 * errors[errors.size() * 9 / 10],
               100 * errors.back());
}

std::string table(double poisson_ratio) {
  const std::string file = sceneFile(poisson_ratio);
  const Scene scene = loadScene(file);
  const auto cell = std::make_shared<const SurrogateData>(surrogateScene(scene, file));
  reportTimes(scene, cell);
  std::fprintf(stderr, "surrogate: energy created on closed paths: at most %.2g of what was exchanged\n",
               createdEnergy(scene, cell));
  for (const double speed : {10e-6, 100e-6, 1e-3}) {
    std::cerr << runForked([&] { return memoryError(scene, cell, speed); }, kTimeLimit).output;
  }
  for (const auto& [angle, end] : {std::pair{0.0, Eigen::Vector3d(4e-6, 0, -10e-6)},
                                   {45.0, {0, 4e-6, -10e-6}},
                                   {30.0, {-4e-6, 0, -4e-6}},
                                   {60.0, {-5e-6, 0, -6.5e-6}}}) {
    const double at = angle;
    const Eigen::Vector3d to = end;
    std::cerr << runForked([&] { return pathDependence(scene, at, to); }, kTimeLimit).output;
  }
  std::string text = "angle_deg,lateral_x_m,lateral_y_m,depth_m,force_N,reference_N,error,surface_rms_m\n";
  std::cout << text;
  for (const TrainingRay& ray : unseenPaths(cell->range)) {
    const ForkedCase outcome = runForked([&] { return solvePath(scene, *cell, ray); }, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << "surrogate: a path failed: " << outcome.failure << '\n';
    std::cout << outcome.output << std::flush;
    text += outcome.output;
  }
  summarise(text);
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  double poisson_ratio = 0.49;
  po::options_description options;
  options.add_options()("poisson-ratio", po::value(&poisson_ratio)->default_value(0.49),
                        "of the cell; another one is prepared first");
  return microinjection::benchMain(
      argc, argv, "surrogate: the surrogate cell's force and surface where it was not trained, and its time",
      [&] { return microinjection::table(poisson_ratio); }, options);
}
