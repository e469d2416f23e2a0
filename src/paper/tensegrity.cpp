// The tensegrity cell of the paper (section III.A): Table II, Figures 2, 3, 11, 12 and 13 as tables; see --help.

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/program_options.hpp>
#include <cstdarg>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/cpu_time.h"
#include "bench/common/call_times.h"
#include "cell/cell_tracker.h"
#include "cell/tensegrity_cell.h"
#include "contact/tip_patch.h"
#include "mechanics/largest_frequency.h"
#include "tensegrity/spin_stop.h"
#include "tensegrity/strut_mesh.h"
#include "tensegrity/tensegrity_loading.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tensegrity.yaml";
constexpr double kDensity = 1000;  ///< kg/m^3

/// printf into a string.
std::string line(const char* format, ...) {
  char text[500];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

/// What the needle meets.
enum class Where { kEnd, kMiddle, kEndOfIt, kBetween };  ///< kEndOfIt: of the strut of kMiddle
const char* name(Where where) {
  constexpr const char* kNames[] = {"end", "middle", "end", "between"};
  return kNames[static_cast<int>(where)];
}

int topEnd(const TensegrityGeometry& geometry) {
  int top = 0;
  for (int end = 1; end < 12; ++end) {
    if (geometry.ends[end].z() > geometry.ends[top].z() + 1e-12) top = end;
  }
  return top;
}

int topStrut(const TensegrityGeometry& geometry) {
  const auto height = [&](int strut) {
    return (geometry.ends[geometry.struts[strut][0]] + geometry.ends[geometry.struts[strut][1]]).z();
  };
  int top = 0;
  for (int strut = 1; strut < 6; ++strut) {
    if (height(strut) > height(top) + 1e-12) top = strut;
  }
  return top;
}

std::vector<int> following(const TensegrityStructure& structure, Where where, double tip_radius) {
  const TensegrityGeometry& geometry = structure.geometry();
  if (where == Where::kEnd) return {structure.endNode(topEnd(geometry))};
  if (where == Where::kMiddle) return structure.middleNodes(topStrut(geometry));
  if (where == Where::kEndOfIt) return {structure.endNode(geometry.struts[topStrut(geometry)][0])};
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return findTipPatch(structure.surface(), structure.config().radius * up, up, tip_radius).vertices;
}

using StructurePointer = std::shared_ptr<const TensegrityStructure>;

StructurePointer makeStructure(const TensegrityConfig& config) {
  return std::make_shared<const TensegrityStructure>(config);
}

class Tables {
 public:
  explicit Tables(const std::string& scene, std::string folder)
      : scene_(loadScene(scene)), config_(*scene_.cell.tensegrity), folder_(std::move(folder)) {}

  void members() const {
    const TensegrityGeometry geometry(config_);
    std::string text =
        "kind,young_modulus_Pa,bending_stiffness_Nm2,count,filament_section_m2,filament_radius_m,filament_EA_N,"
        "section_m2,radius_m,EA_N,EI_Nm2,loose_EI_Nm2,length_m,filament_euler_N,euler_N,rest_force_N\n";
    const auto add = [&](const char* kind, const FilamentConfig& filaments, double length, double force) {
      FilamentConfig one = filaments;
      one.count = 1;
      text += line("%s,%.6g,%.6g,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", kind,
                   filaments.young_modulus, filaments.bending_stiffness, filaments.count, one.section(), one.radius(),
                   one.axialStiffness(), filaments.section(), filaments.radius(), filaments.axialStiffness(),
                   filaments.bendingStiffness(), filaments.looseBendingStiffness(), length, one.eulerLoad(length),
                   filaments.eulerLoad(length), force);
    };
    add("actin", config_.actin.filaments, geometry.cables[0].length, config_.actin.tension());
    add("microtubule", config_.microtubules.filaments, geometry.strut_length, -geometry.strut_force);
    add("intermediate", config_.intermediate.filaments, geometry.cables[24].length, config_.intermediate.tension());
    write("members", text);
  }

  /// Force of one curve; stops where there is no equilibrium.
  void curve(const std::string& label, const TensegrityConfig& config, Where where, double deepest, int points) {
    const StructurePointer structure = makeStructure(config);
    TensegrityLoading loading(structure, following(*structure, where, scene_.needle.tip.radius));
    for (int i = 0; i <= points; ++i) {
      const LoadPath::Result result = loading.advance({0, 0, -deepest * i / points});
      if (!result.converged) {
        std::cerr << label << ": no equilibrium beyond " << -1e6 * loading.displacement().z() << " um\n";
        break;
      }
      int slack = 0;
      for (int k = 0; k < loading.cables().elementCount(); ++k)
        slack += loading.cables().tension(k, loading.state()) == 0;
      double compression = 0;
      for (int strut = 0; strut < 6; ++strut) {
        compression = std::max(compression, -structure->strutForce(strut, loading.state()));
      }
      const Eigen::Vector3d force = loading.force();
      curves_ +=
          line("%s,%s,%.6g,%d,%s,%.6g,%.6g,%.6g,%.6g,%d,%.6g,%d\n", label.c_str(), name(where), config.actin.prestrain,
               config.actin.filaments.count, config.microtubules.model.c_str(), -loading.displacement().z(), force.x(),
               force.y(), force.z(), slack, compression, loading.snaps());
    }
    std::cout << label << ", " << name(where) << " done" << std::endl;
    write("curves",
          "curve,where,prestrain,count,model,depth_m,force_x_N,force_y_N,force_z_N,slack,compression_N,snaps\n" +
              curves_);
  }

  void figure12() {
    for (const double prestrain : {0.0, 0.05, 0.1, 0.2}) {
      TensegrityConfig config = config_;
      config.actin.prestrain = config.intermediate.prestrain = prestrain;
      for (const Where where : {Where::kEnd, Where::kBetween}) curve("figure_12", config, where, 10e-6, 10);
    }
  }

  void figure13() {
    for (const double share : {1.0, 0.3, 0.1}) {
      TensegrityConfig config = config_;
      config.actin.filaments.count = config.intermediate.filaments.count = static_cast<int>(100 * share);
      config.microtubules.filaments.count = static_cast<int>(config.microtubules.filaments.count * std::sqrt(share));
      curve("figure_13", config, Where::kEnd, 45e-6, 18);
      if (share == 1) curve("figure_13", config, Where::kBetween, 45e-6, 18);
    }
    for (const std::string& model : {std::string("linear"), std::string("st_venant_kirchhoff")}) {
      TensegrityConfig config = config_;
      config.microtubules.model = model;
      curve("models", config, Where::kEnd, 10e-6, 10);
    }
  }

  /// Struts, cables and strut ends at rest and under the two loads of Figure 11.
  void figure11() {
    TensegrityConfig config = config_;
    config.orientation = "edge";
    const auto structure = makeStructure(config);
    std::string text = "case,kind,x1_m,y1_m,z1_m,x2_m,y2_m,z2_m,force_N\n",
                loads = "case,depth_m,force_N,largest_end_m,mean_end_m\n";
    const auto draw = [&](const char* label, const Cables& cables, const Eigen::VectorXd& state) {
      const auto add = [&](const char* kind, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double force) {
        text += line("%s,%s,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", label, kind, a.x(), a.y(), a.z(), b.x(), b.y(),
                     b.z(), force);
      };
      for (int strut = 0; strut < 6; ++strut) {
        const std::vector<Eigen::Vector3d> points = structure->strutLine(strut, state);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
          add("strut", points[i], points[i + 1], structure->strutForce(strut, state));
        }
      }
      for (int i = 0; i < cables.elementCount(); ++i) {
        add(structure->isActin(i) ? "actin" : "intermediate", structure->position(cables.cable(i).a, state),
            structure->position(cables.cable(i).b, state), cables.tension(i, state));
      }
    };
    draw("rest", *structure->makeParts().cables, structure->start());
    for (const Where where : {Where::kMiddle, Where::kEndOfIt}) {
      TensegrityLoading loading(structure, following(*structure, where, scene_.needle.tip.radius));
      for (int i = 1; i <= 16; ++i) {
        if (!loading.advance({0, 0, -0.5e-6 * i}).converged) break;
        double largest = 0, mean = 0;
        for (int end = 0; end < 12; ++end) {
          const int node = structure->endNode(end);
          const double way = (loading.state() - structure->start()).segment<3>(3 * node).norm();
          largest = std::max(largest, way);
          mean += way / 12;
        }
        loads += line("%s,%.6g,%.6g,%.6g,%.6g\n", name(where), -loading.displacement().z(), loading.force().z(),
                      largest, mean);
      }
      draw(name(where), loading.cables(), loading.state());
    }
    write("shapes", text);
    write("loads", loads);
  }

  /// Bending stiffness of a strut's mesh over that of the beam, hinged at both ends and loaded in the middle.
  static double locking(const FilamentConfig& filaments, double length, int slices, ElementKind kind) {
    const StrutMesh strut({length, filaments.section(), slices, 0}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(),
                          Eigen::Vector3d::UnitY());
    MaterialConfig material;
    material.model = "linear";
    material.young_modulus = filaments.young_modulus;
    material.poisson_ratio = 0.3;
    const auto middle = [&](int a, int b) -> Eigen::Vector3d {
      return 0.5 * (strut.mesh.vertices[a] + strut.mesh.vertices[b]);
    };
    const auto body = std::make_shared<LayeredBody<3>>(
        makeQuadratic(strut.mesh, middle), kind, LayeredBody<3>::Materials{std::shared_ptr(makeMaterial(material))});
    const double beam =
        48 * filaments.young_modulus * StrutMesh::secondMoment(filaments.section()) / std::pow(length, 3);
    Constraints held;
    held.entries.assign(body->stateSize(), Constraints::kFree);
    for (int k = 0; k < 3; ++k) {
      held.entries[body->tipEntry() + k] = Constraints::tip(k);
      held.entries[3 * strut.firstApex() + k] = Constraints::kFixed;
      if (k > 0) held.entries[3 * strut.lastApex() + k] = Constraints::kFixed;
    }
    for (int corner = 0; corner < StrutMesh::kCorners; ++corner) {
      held.entries[3 * strut.vertex(slices / 2, corner) + 2] = Constraints::tip(2);
    }
    const Eigen::VectorXd start = Eigen::VectorXd::Zero(body->stateSize());
    const std::vector<std::array<int, 2>> pair = {{strut.vertex(slices / 2, 0), strut.vertex(slices / 2, 2)}};
    const auto spin = std::make_shared<SpinStop>(pair, 1e-3 * beam, start);
    EquilibriumSystem system({body, spin}, held, SymmetricSolver::Method::kSimplicial);
    return system.factorise(start) ? system.stiffness()(2, 2) / beam : std::numeric_limits<double>::quiet_NaN();
  }

  void bending() const {
    std::string text = "count,radius_m,slices,element,ratio\n";
    const double length = TensegrityGeometry(config_).strut_length;
    for (const int count : {1, 10, 100, 1000, 4000, 12500, 40000}) {
      FilamentConfig filaments = config_.microtubules.filaments;
      filaments.count = count;
      const auto add = [&](int slices, ElementKind kind, const char* element) {
        text += line("%d,%.6g,%d,%s,%.6g\n", count, filaments.radius(), slices, element,
                     locking(filaments, length, slices, kind));
      };
      add(32, ElementKind::kP1, "p1");
      if (count >= 100) add(128, ElementKind::kP1, "p1");
      if (count >= 100) add(32, ElementKind::kP2, "p2");
    }
    write("bending", text);
  }

  void numbers() {
    std::string text = "quantity,value\n";
    const auto add = [&](const char* quantity, double value) { text += line("%s,%.6g\n", quantity, value); };
    const double start = threadCpuTime();
    const auto cell = std::make_shared<const TensegrityCell>(scene_);
    const TensegrityStructure& structure = cell->structure();
    add("form_finding_s", threadCpuTime() - start);
    add("residual_N", structure.form().residual);
    add("prestress_N", structure.form().prestress);
    add("strut_vertices", structure.struts().mesh().vertex_count);
    add("strut_tetrahedra", structure.struts().elementCount());
    add("membrane_vertices", static_cast<double>(structure.surface().vertices.size()));
    add("step_s", stableStep(structure));
    // As little of a wave's way across a single microtubule's radius.
    const FilamentConfig& tubules = config_.microtubules.filaments;
    add("wave_speed_m_s", std::sqrt(tubules.young_modulus / kDensity));
    add("single_filament_step_s", tubules.filamentRadius() / std::sqrt(tubules.young_modulus / kDensity));
    serve(cell, add);
    write("numbers", text);
  }

 private:
  /// s, of central differences at the true, lumped mass (struts of 1000 kg/m^3, membrane by its thickness; cables' mass
  /// is left out, which would count for nothing).
  static double stableStep(const TensegrityStructure& structure) {
    const LayeredBody<3>& struts = structure.struts();
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(structure.nodePlaces().size()));
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

  /// Processor time of a force for a needle that goes in at 10 um/s, at 1 kHz: in lock step with the solving thread, so
  /// that what else the machine does is not counted.
  template <typename Add>
  void serve(const std::shared_ptr<const TensegrityCell>& cell, const Add& add) const {
    constexpr int kSteps = 4000;
    CellTrackerConfig config;
    config.fixed_period = true;
    config.solution_period = 0.1;
    CellTracker tracker(cell, config);
    const Eigen::Vector3d end = cell->structure().geometry().ends[topEnd(cell->structure().geometry())];
    std::vector<double> times, solutions;
    int untrusted = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double time = 1e-3 * i;
      const Eigen::Vector3d tip = end + Eigen::Vector3d(0, 0, 5e-6 - 1e-8 * i);
      const double start = threadCpuTime();
      const TipForce force = tracker.step(tip, Eigen::Vector3d::UnitZ(), time);
      times.push_back(threadCpuTime() - start);
      untrusted += !force.trusted;
      if (const auto solution = tracker.solution(time)) solutions.push_back(solution->cpu_time);
    }
    add("force_median_s", quantile(times, 0.5));
    add("force_99_s", quantile(times, 0.99));
    add("force_longest_s", quantile(times, 1));
    add("solution_median_s", quantile(solutions, 0.5));
    add("solution_longest_s", quantile(solutions, 1));
    add("untrusted_share", static_cast<double>(untrusted) / kSteps);
  }

  void write(const std::string& table, const std::string& text) const {
    writeFileAtomically(folder_ + "/tensegrity_" + table + ".csv", text);
  }

  Scene scene_;
  TensegrityConfig config_;
  std::string folder_, curves_;
};

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string folder, scene;
  po::options_description options(
      "tensegrity: the paper's tensegrity cell, Table II and Figures 2, 3 and 11 to 13 as CSV tables. Options");
  options.add_options()("help", "this text")("out", po::value(&folder),
                                             "folder to write tensegrity_*.csv to; required")(
      "scene", po::value(&scene)->default_value(kScene), "scene file of model tensegrity");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  po::notify(values);
  if (values.count("help") != 0 || folder.empty()) {
    std::cout << options;
    return folder.empty() && values.count("help") == 0 ? 2 : 0;
  }
  Tables tables(scene, folder);
  tables.members();
  tables.numbers();
  tables.bending();
  tables.figure11();
  tables.figure12();
  tables.figure13();
  return 0;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "tensegrity: " << error.what() << '\n';
    return 2;
  }
}
