#pragma once

#include <Eigen/Core>
#include <memory>

#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// A cell of any size and stiffness, whose membranes fail, from a prepared one by dimensional
/// analysis: with gravity and inertia left out, a homogeneous neo-Hookean cell's force is F = E R^2
/// f(x / R), so lengths scale with R and forces with E R^2. Everything scales: holding pipette and
/// needle, too, so that a cell twice as large meets a tip twice as large. Times do not, and neither does the needle's
/// bore, which is small against any cell.
class ScaledCell {
 public:
  /// Of the wanted cell.
  struct Properties {
    double diameter = 56e-6;        ///< m
    double young_modulus = 17.9e3;  ///< Pa, of a load held for ever
    std::vector<PronyTerm> prony;
    PunctureConfig puncture;  ///< of the wanted cell; `damping` and `lateral_stiffness` of the shaft 0
    double bore_radius = 0;   ///< m, of its needle; 0: it has none
  };

  /// @param scene  of `prepared`: one layer, elastic
  /// @param tongue of a needle with the wanted cell's bore; none: nothing is drawn in
  /// @param branch of `scene` with the wanted cell's toughness over E R, for a first layer with a toughness
  ScaledCell(const Scene& scene, std::shared_ptr<const SurrogateData> prepared, const Properties& properties,
             const std::optional<BoreTongue>& tongue = {}, std::optional<PiercedBranch> branch = {});

  /// N, on a tip at `tip` (m), upright, at `time` (s).
  Eigen::Vector3d step(const Eigen::Vector3d& tip, double time);

  void setBoreLine(const CellModel::BoreLine& line);  ///< of the wanted cell's needle, from the next step on
  double boreLength() const;                          ///< m, of the cell in the bore
  double boreVolume() const;                          ///< m^3, same
  int layersPunctured() const { return cell_->insertion().layers_punctured; }
  bool touched() const { return cell_->contact().has_value(); }
  /// In contact, or through a membrane.
  bool inCell() const { return touched() || cell_->insertion().inside; }
  bool valid() const { return valid_; }  ///< the last force
  /// E R^2 (N): the size of its forces.
  double forceScale() const { return force_scale_; }

 private:
  double length_, force_;  ///< of the wanted cell over the prepared one
  double force_scale_;     ///< N
  bool valid_ = true;
  std::unique_ptr<PuncturableCell> cell_;
};

}  // namespace microinjection
