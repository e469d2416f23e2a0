#include "benchmark/paper/tensegrity_members.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/tensegrity/spin_stop.h"
#include "cell/tensegrity/strut_mesh.h"

namespace microinjection {
namespace {

/// Bending stiffness of a strut's mesh over that of the beam, hinged at both ends and loaded in the
/// middle.
double locking(const FilamentConfig& filaments, double length, int slices, ElementKind kind) {
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
  const double beam = 48 * filaments.young_modulus * StrutMesh::secondMoment(filaments.section()) / std::pow(length, 3);
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

}  // namespace

void writeMembers(const TensegrityStudy& study) {
  const TensegrityGeometry geometry(study.config());
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
  add("actin", study.config().actin.filaments, geometry.cables[0].length, study.config().actin.tension());
  add("microtubule", study.config().microtubules.filaments, geometry.strut_length, -geometry.strut_force);
  add("intermediate", study.config().intermediate.filaments, geometry.cables[24].length,
      study.config().intermediate.tension());
  study.write("members", text);
}

void writeBending(const TensegrityStudy& study) {
  std::string text = "count,radius_m,slices,element,ratio\n";
  const double length = TensegrityGeometry(study.config()).strut_length;
  for (const int count : {1, 10, 100, 1000, 4000, 12500, 40000}) {
    FilamentConfig filaments = study.config().microtubules.filaments;
    filaments.count = count;
    const auto add = [&](int slices, ElementKind kind, const char* element) {
      text += line("%d,%.6g,%d,%s,%.6g\n", count, filaments.radius(), slices, element,
                   locking(filaments, length, slices, kind));
    };
    add(32, ElementKind::kP1, "p1");
    if (count >= 100) add(128, ElementKind::kP1, "p1");
    if (count >= 100) add(32, ElementKind::kP2, "p2");
  }
  study.write("bending", text);
}

}  // namespace microinjection
