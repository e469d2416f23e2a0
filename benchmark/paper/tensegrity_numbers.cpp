#include "benchmark/paper/tensegrity_numbers.h"

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "base/cpu_time.h"
#include "benchmark/common/call_times.h"
#include "cell/mechanics/largest_frequency.h"
#include "cell/model/live_cell_model.h"
#include "cell/model/tensegrity_cell.h"

namespace microinjection {
namespace {

constexpr double kDensity = 1000;  ///< kg/m^3

/// s, of central differences at the true, lumped mass (struts of 1000 kg/m^3, membrane by its
/// thickness; cables' mass is left out, which would count for nothing).
double stableStep(const TensegrityStructure& structure) {
  const LayeredBody<3>& struts = structure.struts();
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(structure.nodePositions().size()));
  for (int e = 0; e < struts.elementCount(); ++e) {
    for (int corner = 0; corner < 4; ++corner)
      mass[struts.mesh().elements[e][corner]] += kDensity * struts.weight(e, 0) / 4;
  }
  const SurfaceMesh& surface = structure.surface();
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d a = surface.vertices[t[1]] - surface.vertices[t[0]],
                          b = surface.vertices[t[2]] - surface.vertices[t[0]];
    const double share = kDensity * structure.config().membrane.thickness * 0.5 * a.cross(b).norm() / 3;
    for (const int corner : t) mass[surface.mesh_vertices[corner]] += share;
  }
  EquilibriumSystem system(structure.makeParts().terms, structure.constraints({}),
                           SymmetricSolver::Method::kSimplicial);
  system.assemble(structure.start());
  Eigen::VectorXd of_free(system.freeSize());
  const Constraints constraints = structure.constraints({});
  for (std::size_t i = 0, next = 0; i + 3 < constraints.entries.size(); ++i) {
    if (constraints.entries[i] == Constraints::kFree) of_free[next++] = mass[i / 3];
  }
  return 2 / largestFrequency(system.matrix(), of_free);
}

/// Processor time of a force for a needle that goes in at 10 um/s, at 1 kHz: in lock step with the
/// solving thread, so that what else the machine does is not counted.
template <typename Add>
void serve(const std::shared_ptr<const TensegrityCell>& cell, const Add& add) {
  constexpr int kSteps = 4000;
  LiveCellModelConfig config;
  config.fixed_period = true;
  config.solution_period = 0.1;
  LiveCellModel tracker(cell, config);
  const Eigen::Vector3d end = cell->structure().geometry().ends[topEnd(cell->structure().geometry())];
  std::vector<double> times, solutions;
  int invalid = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double time = 1e-3 * i;
    const Eigen::Vector3d tip = end + Eigen::Vector3d(0, 0, 5e-6 - 1e-8 * i);
    const double start = threadCpuTime();
    const TipForce force = tracker.step(tip, Eigen::Vector3d::UnitZ(), time);
    times.push_back(threadCpuTime() - start);
    invalid += !force.valid;
    if (const auto solution = tracker.solution(time)) solutions.push_back(solution->cpu_time);
  }
  add("force_median_s", quantile(times, 0.5));
  add("force_99_s", quantile(times, 0.99));
  add("force_longest_s", quantile(times, 1));
  add("solution_median_s", quantile(solutions, 0.5));
  add("solution_longest_s", quantile(solutions, 1));
  add("invalid_share", static_cast<double>(invalid) / kSteps);
}

}  // namespace

void writeNumbers(const TensegrityStudy& study) {
  std::string text = "quantity,value\n";
  const auto add = [&](const char* quantity, double value) { text += line("%s,%.6g\n", quantity, value); };
  const double start = threadCpuTime();
  const auto cell = std::make_shared<const TensegrityCell>(study.scene);
  const TensegrityStructure& structure = cell->structure();
  add("form_finding_s", threadCpuTime() - start);
  add("residual_N", structure.form().residual);
  add("prestress_N", structure.form().prestress);
  add("strut_vertices", structure.struts().mesh().vertex_count);
  add("strut_tetrahedra", structure.struts().elementCount());
  add("membrane_vertices", static_cast<double>(structure.surface().vertices.size()));
  add("step_s", stableStep(structure));
  // As little of a wave's way across a single microtubule's radius.
  const FilamentConfig& tubules = study.config().microtubules.filaments;
  add("wave_speed_m_s", std::sqrt(tubules.young_modulus / kDensity));
  add("single_filament_step_s", tubules.filamentRadius() / std::sqrt(tubules.young_modulus / kDensity));
  serve(cell, add);
  study.write("numbers", text);
}

}  // namespace microinjection
