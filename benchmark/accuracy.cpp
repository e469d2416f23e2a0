// Error of the force against time and size: every model and element, converged references.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/forked_case.h"
#include "benchmark/common/reference_scenes.h"
#include "cell/model/cell_problem.h"
#include "cell/model/indentation.h"
#include "cell/model/p1_cell.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr unsigned kTimeLimit = 150;  ///< s, of one mesh

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Case {
  std::string model, element;
  std::size_t vertices = 0, elements = 0;
  double start = now();  ///< s, so that the time of a row is that of its mesh and of all depths so far
};

std::string row(const ReferenceScene& scene, const Case& made, const ReferenceScene::Point& point,
                const IndentationSolution& solution) {
  const double force = solution.converged ? solution.force.z() : std::numeric_limits<double>::quiet_NaN();
  char text[300];
  std::snprintf(text, sizeof(text), "%s,%s,%s,%zu,%zu,%.4g,%.6g,%.6g,%.5f,%.3f", scene.name.c_str(), made.model.c_str(),
                made.element.c_str(), made.vertices, made.elements, point.depth, force, point.force,
                force / point.force - 1, now() - made.start);
  return text;
}

template <int Dim>
std::string converging(const ReferenceScene& scene, const std::string& element, double level) {
  Case made{Dim == 2 ? "axisymmetric" : "spatial", element};
  QuadraticMesh<Dim> mesh = makeSceneMesh<Dim>(scene.scene, level);
  made.vertices = mesh.vertex_count;
  made.elements = mesh.elements.size();
  CellProblem<Dim> problem(scene.scene, std::move(mesh), elementKind(element));
  std::string rows;
  for (const ReferenceScene::Point& point : scene.points) {
    const IndentationSolution solution = problem.solve({0, 0, -point.depth});
    rows += row(scene, made, point, solution) + "\n";
    if (!solution.converged) break;
  }
  return rows;
}

/// The mesh of a live session, whose element and refinement are the paper's.
std::string live(const ReferenceScene& scene, double size) {
  Case made{"live", "p1"};
  Scene changed = scene.scene;
  changed.mesh.size = size;
  const auto cell = std::make_shared<const P1Cell>(changed);
  made.vertices = cell->mesh().vertices.size();
  made.elements = cell->mesh().tetrahedra.size();
  Indentation indentation(cell, cell->patchAt({0, 0, changed.radius()}, Eigen::Vector3d::UnitZ()));
  std::string rows;
  for (const ReferenceScene::Point& point : scene.points) {
    const IndentationSolution solution = indentation.solve({0, 0, -point.depth});
    rows += row(scene, made, point, solution) + "\n";
    if (!solution.converged) break;
  }
  return rows;
}

class Table {
 public:
  Table() { std::cout << text_; }

  void add(const std::string& what, const std::function<std::string()>& work) {
    const ForkedCase outcome = runForked(work, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << what << ": " << outcome.failure << '\n';
    std::string rows;
    std::istringstream lines(outcome.output);
    char memory[40];
    std::snprintf(memory, sizeof(memory), ",%.0f\n", outcome.memory_megabytes);
    for (std::string line; std::getline(lines, line);) rows += line + memory;
    std::cout << rows << std::flush;
    text_ += rows;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_ = "scene,model,element,vertices,elements,depth_m,force_N,reference_N,error,time_s,memory_MB\n";
};

std::string table() {
  Table table;
  for (const ReferenceScene& scene : referenceScenes()) {
    const bool rounded = scene.scene.needle.tip.rounded();
    for (const std::string& element : elementNames()) {
      for (int level = 0; level <= (rounded ? 1 : 4); ++level) {
        table.add(scene.name + " axisymmetric " + element, [&] { return converging<2>(scene, element, level); });
      }
      // Space takes minutes; what the elements are worth there shows on two scenes.
      if (rounded || scene.scene.cell.layers.size() > 1) continue;
      const double finest = element == "p2_p0" ? 0.5 : 0;
      for (double level = -0.5; level <= finest; level += 0.5) {
        table.add(scene.name + " spatial " + element, [&] { return converging<3>(scene, element, level); });
      }
    }
    for (double size : {20e-6, 15e-6, 10e-6, 7e-6}) {
      if (!rounded) table.add(scene.name + " live", [&] { return live(scene, size); });
    }
  }
  return table.text();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv,
                                   "accuracy: error of the force of every model and element against test/reference",
                                   microinjection::table);
}
