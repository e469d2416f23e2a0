#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/material/viscoelastic_step.h"
#include "cell/material/viscoelasticity.h"
#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/layered_body.h"

namespace microinjection {

/// Viscoelastic part of a body's energy in a load step: the incremental potential of
/// ViscoelasticStep, integrated over the elements of the viscoelastic layers at the body's own
/// quadrature points. Only its derivatives have a meaning: the energy, J, is defined up to a
/// constant that differs between steps.
///
/// In an infinite duration everything relaxes and the term vanishes, as it does before the first
/// beginStep. Each point stores the last accepted step. Repeating a step, also with another
/// duration, starts from there.
template <int Dim>
class ViscousStress : public EnergyTerm {
 public:
  /// @param layers of each layer of the body; an empty one leaves its layer elastic
  /// @throws std::invalid_argument when their number is not that of the body's materials,
  ///   ConfigError when one is not valid
  ViscousStress(std::shared_ptr<const LayeredBody<Dim>> body, std::vector<ViscoelasticityConfig> layers);

  int elementCount() const override { return static_cast<int>(elements_.size()); }
  /// The displacements of the body's entries, without pressures.
  const std::vector<int>& entries(int element) const override { return elements_[element].entries; }

  /// False when the material's energy is not defined.
  bool evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;

  /// True when `duration` is finite. Throws std::invalid_argument when it is not positive.
  bool beginStep(double duration) override;

  /// The state stays at equilibrium until another step begins.
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

 private:
  struct Element {
    int index;  ///< in the body
    int layer;
    std::vector<int> entries;
    std::vector<ViscoelasticMemory> memory;  ///< at the quadrature points
  };

  template <int N>
  bool evaluateNodes(const Element& element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const;

  std::shared_ptr<const LayeredBody<Dim>> body_;
  std::vector<ViscoelasticityConfig> layers_;
  std::vector<Element> elements_;
  std::vector<ViscoelasticStep> steps_;  ///< of each layer
  bool relaxed_ = true;                  ///< in the present step
};

}  // namespace microinjection
