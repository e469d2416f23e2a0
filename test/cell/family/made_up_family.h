#pragma once

#include <cmath>

#include "cell/family/family_data.h"
#include "cell/family/family_places.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {

inline Family homogeneous() { return Family::load(MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml"); }

/// A made-up member: a spring whose stiffness depends smoothly on the coordinates, and a surface that follows the tip.
struct MadeUp {
  FamilyMember member;
  Eigen::MatrixXf surface;

  explicit MadeUp(const Eigen::VectorXd& x) {
    member.coordinates = x;
    member.scale = std::exp(0.7 * x[0] - 0.2 * x[1]);
    member.energy = Eigen::VectorXd::Zero(EnergyExpansion(EnergyScales(), EnergyDegrees()).size());
    member.energy[0] = 1 + 0.2 * x[2];
    member.field = Eigen::VectorXd::Zero(ForceField(EnergyScales()).coefficients().size());
    member.field.tail(1)[0] = 0;
    member.field[0] = 0.1 * x[1];
    member.field[member.field.size() - 40] = 1 + 0.2 * x[2] + 0.05 * x[0] * x[1];
    member.median_error = 0.003;
    member.common_error = 0.008;
    const Eigen::Index entries = 3 * static_cast<Eigen::Index>(SurfaceGrid::standard().nodeCount());
    const auto places = surfacePlaces(familyRange(1, 1));
    surface.resize(entries, static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto depth = static_cast<float>(-places[i].displacement.z() * (1 + 0.1 * x[0]));
      surface.col(static_cast<Eigen::Index>(i)) = depth * Eigen::VectorXf::LinSpaced(entries, 0, 1);
    }
  }
};

/// With members on a grid.
inline FamilyData familyOfSprings() {
  FamilyData data(homogeneous());
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        const MadeUp made(Eigen::Vector3d(x, y, z));
        data.add(made.member, made.surface);
      }
    }
  }
  data.update();
  data.setProvenance("made up");
  return data;
}

}  // namespace microinjection
