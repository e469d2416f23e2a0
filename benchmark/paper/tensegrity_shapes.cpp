#include "benchmark/paper/tensegrity_shapes.h"

#include <algorithm>
#include <memory>

#include "cell/tensegrity/tensegrity_loading.h"

namespace microinjection {
namespace {

/// Struts, piece by piece, and cables of a state, as rows.
std::string drawing(const char* label, const TensegrityStructure& structure, const Cables& cables,
                    const Eigen::VectorXd& state) {
  std::string rows;
  const auto add = [&](const char* kind, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double force) {
    rows += line("%s,%s,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", label, kind, a.x(), a.y(), a.z(), b.x(), b.y(), b.z(),
                 force);
  };
  for (int strut = 0; strut < 6; ++strut) {
    const std::vector<Eigen::Vector3d> points = structure.strutLine(strut, state);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      add("strut", points[i], points[i + 1], structure.strutForce(strut, state));
    }
  }
  for (int i = 0; i < cables.elementCount(); ++i) {
    add(structure.isActin(i) ? "actin" : "intermediate", structure.position(cables.cable(i).a, state),
        structure.position(cables.cable(i).b, state), cables.tension(i, state));
  }
  return rows;
}

/// Force, and how far the strut ends have moved.
std::string loadRow(const char* label, const TensegrityLoading& loading) {
  const TensegrityStructure& structure = loading.structure();
  double largest = 0, mean = 0;
  for (int end = 0; end < 12; ++end) {
    const int node = structure.endNode(end);
    const double moved = (loading.state() - structure.start()).segment<3>(3 * node).norm();
    largest = std::max(largest, moved);
    mean += moved / 12;
  }
  return line("%s,%.6g,%.6g,%.6g,%.6g\n", label, -loading.displacement().z(), loading.force().z(), largest, mean);
}

}  // namespace

void writeShapes(const TensegrityStudy& study) {
  TensegrityConfig config = study.config();
  config.orientation = "edge";
  const auto structure = std::make_shared<const TensegrityStructure>(config);
  std::string shapes = "case,kind,x1_m,y1_m,z1_m,x2_m,y2_m,z2_m,force_N\n",
              loads = "case,depth_m,force_N,largest_end_m,mean_end_m\n";
  shapes += drawing("rest", *structure, *structure->makeParts().cables, structure->start());
  for (const Where where : {Where::kMiddle, Where::kEndOfIt}) {
    TensegrityLoading loading(structure, following(*structure, where, study.scene.needle.tip.radius));
    for (int i = 1; i <= 16; ++i) {
      if (!loading.advance({0, 0, -0.5e-6 * i}).converged) break;
      loads += loadRow(name(where), loading);
    }
    shapes += drawing(name(where), *structure, loading.cables(), loading.state());
  }
  study.write("shapes", shapes);
  study.write("loads", loads);
}

}  // namespace microinjection
