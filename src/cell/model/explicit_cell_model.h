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
/// biological cell injection").
///
/// The cell's true mass would need steps of some 10 ns. The mass is scaled so that `time_step` is
/// stable for the undeformed cell; description() says how far the force then lags behind the
/// needle. The force is that of the vertices under the tip, and includes their inertia's reaction.
/// For a homogeneous cell and a disc tip.
class ExplicitCellModel : public CellModel {
 public:
  /// Throws ConfigError for a scene that P1Cell refuses, more than one layer, or a material that is
  /// neither st_venant_kirchhoff nor linear; else as P1Cell does.
  ExplicitCellModel(const Scene& scene, const ExplicitCellModelConfig& config);

  /// What the model is, and its error in plain words.
  std::string description() const;

  /// Advances the dynamics to `time`, at most by 0.01 s; the tip moves there in a straight line.
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
  int hint_ = 0;  ///< see OnlineCell::touch
  LatestValue<Shape> shape_;
};

}  // namespace microinjection
