#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "base/latest_value.h"
#include "cell/mechanics/explicit_step.h"
#include "cell/model/cell_model.h"
#include "cell/model/p1_cell.h"

namespace microinjection {

struct ExplicitCellModelConfig {
  double time_step = 2e-4;  ///< s, of the dynamics; the mass is scaled until this step is stable

  static ExplicitCellModelConfig read(ConfigReader& reader);
};

/// The paper's own loop: P1 tetrahedra and central differences at the rate of the haptic device
/// (equation (13) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted
/// biological cell injection"). It is there to feel and to measure that loop; LiveCellModel solves the same tetrahedra
/// for their equilibrium, whose force depends neither on a mass nor on a time step.
///
/// An explicit step needs no equations to be solved, but it is stable only while it is shorter than the time in which a
/// sound wave crosses an element. At the cell's true mass that is some 20 ns for the 604 vertices of the benchmark, so
/// a millisecond of the needle would need some 50,000 steps. The mass is therefore scaled until `time_step` is stable
/// for the undeformed cell: 9e7 times there (doc/reference/benchmarks.md, The paper's explicit dynamics). The price is
/// a force that lags: it settles in 0.32 s, and a linear cell's is 97 to 390 % too large at 5 to 100 um/s, locking
/// included. description() has mass scale and settling time of the cell at hand. The damping is critical for a shear
/// wave of two diameters, about the slowest motion of the cell, so that the force settles without ringing.
///
/// The bound of the step is that of the undeformed cell (frequencyBound), and half of it is used, because the cell
/// stiffens when it is pressed. A step that is unstable all the same is found by its energy: a stable cell cannot move
/// with much more than the needle has put in. The force is then invalid until the needle is withdrawn, and so it is
/// while an element is inverted. A linear cell has no inversion.
///
/// The force is that of the vertices under the tip, and includes their inertia's reaction. For a homogeneous cell and a
/// disc tip.
class ExplicitCellModel : public CellModel {
 public:
  /// Throws ConfigError for a scene that P1Cell refuses, more than one layer, or a material that is
  /// neither st_venant_kirchhoff nor linear; else as P1Cell does.
  ExplicitCellModel(const Scene& scene, const ExplicitCellModelConfig& config);

  /// What the model is, and its error in plain words.
  std::string description() const;

  /// Advances the dynamics to `time`, at most by 0.01 s; the tip moves there in a straight line. What is left of a
  /// longer gap is dropped, so that one late step does not make the next ones late by catching up.
  TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) override;
  /// Restores the undeformed cell: after a puncture nothing steps it until the next contact.
  void release() override;

  const std::optional<Contact>& contact() const override { return contact_; }
  const std::string& invalidReason() const override { return invalid_reason_; }
  std::optional<Solution> solution(double) const override { return std::nullopt; }  ///< dynamics has none
  std::vector<std::array<int, 3>> triangles() const override { return cell_->surface().triangles; }
  std::vector<std::uint32_t> held() const override { return cell_->undeformedSurface().held; }
  DeformedSurface deformedSurface() override;

 private:
  struct Shape {
    std::vector<Eigen::Vector3d> displacement;    ///< m, of each vertex of the surface
    std::vector<std::uint32_t> contact_vertices;  ///< vertices of the surface
  };

  TipForce computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time);
  void engage(const Eigen::Vector3d& touch, const Eigen::Vector3d& axis);
  void advance(const Eigen::Vector3d& displacement, double time);
  void disengage();
  void restore();
  bool isStable() const;
  const char* defect() const;
  TipForce invalidForce(const char* reason);
  void writeShape();

  std::shared_ptr<const P1Cell> cell_;
  double mass_scale_ = 1;
  double settling_time_ = 0;  ///< s, in which the scaled cell's slowest shear wave decays to a hundredth
  std::optional<ExplicitStep> dynamics_;
  std::optional<double> time_;  ///< s, that the dynamics has reached
  std::optional<Contact> contact_;
  Eigen::Vector3d applied_ = Eigen::Vector3d::Zero();  ///< m, displacement of the tip in the last time step
  Eigen::Vector3d last_move_ = Eigen::Vector3d::Zero();
  double work_ = 0;           ///< J, of the needle on the cell
  double negligible_energy_;  ///< J
  bool may_invert_ = false, touches_held_ = false, unstable_ = false, inverted_ = false;
  Shape drawn_;
  std::string invalid_reason_;
  int hint_ = 0;  ///< see LiveCell::touch
  LatestValue<Shape> shape_;
};

}  // namespace microinjection
